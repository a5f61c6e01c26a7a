#include <cmath>
#include <limits>
#include <random>

#include "tests/kernels/all_paths.hpp"

namespace palpate::kernels {
namespace {

using Matrix = std::vector<std::vector<long double>>;

/// Symmetric positive definite, condition of order n.
Matrix random_spd(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<std::vector<double>> b(n, std::vector<double>(n));
  for (auto& row : b)
    for (double& x : row) x = uniform(random);
  Matrix a(n, std::vector<long double>(n));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      double sum = i == j ? 1 : 0;
      for (int k = 0; k < n; ++k) sum += b[i][k] * b[j][k];
      a[i][j] = a[j][i] = sum;
    }
  return a;
}

Matrix plain_cholesky(Matrix a) {
  const int n = static_cast<int>(a.size());
  for (int j = 0; j < n; ++j) {
    a[j][j] = std::sqrt(a[j][j]);
    for (int i = j + 1; i < n; ++i) a[i][j] /= a[j][j];
    for (int k = j + 1; k < n; ++k)
      for (int i = k; i < n; ++i) a[i][k] -= a[i][j] * a[k][j];
  }
  return a;
}

/// A factor buffer with a guard behind it; all that is not set is NaN, so that nothing may depend on it.
struct Factor {
  explicit Factor(int largest)
      : ld(leading_dimension(largest)),
        l(ld * largest + 8, std::numeric_limits<double>::quiet_NaN()),
        floor(largest, 1e-30),
        scratch(kMaxBlock * ld, std::numeric_limits<double>::quiet_NaN()) {
    std::fill(l.end() - 8, l.end(), 77.0);
  }
  void load(const Matrix& a) {
    for (std::size_t j = 0; j < a.size(); ++j)
      for (std::size_t i = j; i < a.size(); ++i) at(i, j) = static_cast<double>(a[i][j]);
  }
  double& at(std::size_t i, std::size_t j) { return l[j * ld + i]; }
  bool guarded() const {
    return std::all_of(l.end() - 8, l.end(), [](double x) { return x == 77.0; });
  }

  std::ptrdiff_t ld;
  std::vector<double> l, floor, scratch;
};

class Cholesky : public EveryPath {
 protected:
  int append(Factor& f, const Matrix& a, int n, int k) {
    std::vector<double> rows(k * (n + k + 3), std::numeric_limits<double>::quiet_NaN());
    for (int i = 0; i < k; ++i)
      for (int j = 0; j <= n + i; ++j) rows[i * (n + k + 3) + j] = static_cast<double>(a[n + i][j]);
    return table().cholesky_append(f.l.data(), n, f.ld, rows.data(), n + k + 3, k, f.floor.data() + n);
  }
  void remove(Factor& f, int n, int first, int k) {
    table().cholesky_remove(f.l.data(), n, f.ld, first, k, f.scratch.data());
  }
  void expect_factor(Factor& f, const Matrix& a, double tolerance) {
    const Matrix expected = plain_cholesky(a);
    const double scale = a.empty() ? 1 : static_cast<double>(expected[0][0]);
    for (std::size_t j = 0; j < a.size(); ++j)
      for (std::size_t i = j; i < a.size(); ++i)
        ASSERT_NEAR(f.at(i, j), static_cast<double>(expected[i][j]), tolerance * scale)
            << "entry " << i << "," << j << " of " << a.size();
    ASSERT_TRUE(f.guarded()) << "written behind the buffer";
  }
};

Matrix without(const Matrix& a, int first, int k) {
  Matrix b = a;
  b.erase(b.begin() + first, b.begin() + first + k);
  for (auto& row : b) row.erase(row.begin() + first, row.begin() + first + k);
  return b;
}

Matrix leading(const Matrix& a, int n) {
  return without(a, n, static_cast<int>(a.size()) - n);
}

TEST_P(Cholesky, EqualsThePlainFactorForEveryOrder) {
  for (int n = 0; n <= 70; ++n) {
    const Matrix a = random_spd(n, 100 + n);
    Factor f(n + n % 3);
    f.load(a);
    EXPECT_EQ(table().cholesky(f.l.data(), n, f.ld, f.floor.data()), 0);
    expect_factor(f, a, 1e-12);
  }
}

TEST_P(Cholesky, EqualsThePlainFactorForLargeOrders) {
  for (const int n : {189, 192, 300, 417}) {
    const Matrix a = random_spd(n, n);
    Factor f(n);
    f.load(a);
    EXPECT_EQ(table().cholesky(f.l.data(), n, f.ld, f.floor.data()), 0);
    expect_factor(f, a, 1e-12);
  }
}

TEST_P(Cholesky, SolveInvertsTheMatrix) {
  for (const int n : {1, 2, 3, 7, 8, 9, 12, 24, 31, 64, 101, 192, 300}) {
    const Matrix a = random_spd(n, 3 * n);
    Factor f(n);
    f.load(a);
    table().cholesky(f.l.data(), n, f.ld, f.floor.data());
    std::vector<double> x(n + 8, 77);
    for (int i = 0; i < n; ++i) {
      long double b = 0;
      for (int j = 0; j < n; ++j) b += a[i][j] * std::sin(1.0L + j);
      x[i] = static_cast<double>(b);
    }
    table().cholesky_solve(f.l.data(), n, f.ld, x.data());
    for (int i = 0; i < n; ++i) ASSERT_NEAR(x[i], std::sin(1.0L + i), 1e-9) << n;
    for (int i = n; i < n + 8; ++i) ASSERT_EQ(x[i], 77) << "written beyond the right-hand side";
  }
}

TEST_P(Cholesky, AppendedRowsEqualTheFactorOfTheWhole) {
  for (const int n : {0, 1, 3, 4, 8, 13, 61, 189})
    for (int k = 1; k <= kMaxBlock; ++k) {
      const Matrix a = random_spd(n + k, 50 * n + k);
      Factor f(n + k);
      f.load(leading(a, n));
      table().cholesky(f.l.data(), n, f.ld, f.floor.data());
      EXPECT_EQ(append(f, a, n, k), 0);
      expect_factor(f, a, 1e-12);
    }
}

TEST_P(Cholesky, RemovedRowsLeaveTheFactorOfTheRest) {
  for (const int n : {9, 10, 27, 64})
    for (int k = 1; k <= kMaxBlock; ++k)
      for (int first = 0; first + k <= n; ++first) {
        const Matrix a = random_spd(n, n);
        Factor f(n);
        f.load(a);
        table().cholesky(f.l.data(), n, f.ld, f.floor.data());
        remove(f, n, first, k);
        expect_factor(f, without(a, first, k), 1e-12);
      }
}

TEST_P(Cholesky, LongRandomSequencesOfChangesStayWithTheFreshFactor) {
  const int pool = 96;
  const Matrix all = random_spd(pool, 5);
  std::mt19937 random(11);
  Factor f(pool);
  std::vector<int> held;
  for (int step = 0; step < 4000; ++step) {
    const int k = 1 + static_cast<int>(random() % kMaxBlock), n = static_cast<int>(held.size());
    if (random() % 2 && n >= k) {
      const int first = static_cast<int>(random() % (n - k + 1));
      remove(f, n, first, k);
      held.erase(held.begin() + first, held.begin() + first + k);
    } else if (n + k <= pool) {
      std::vector<int> unused;
      for (int i = 0; i < pool; ++i)
        if (std::find(held.begin(), held.end(), i) == held.end()) unused.push_back(i);
      std::shuffle(unused.begin(), unused.end(), random);
      held.insert(held.end(), unused.begin(), unused.begin() + k);
      Matrix a(n + k, std::vector<long double>(n + k));
      for (int i = 0; i < n + k; ++i)
        for (int j = 0; j < n + k; ++j) a[i][j] = all[held[i]][held[j]];
      ASSERT_EQ(append(f, a, n, k), 0);
    }
    if (step % 97 != 0 && step != 3999) continue;
    Matrix a(held.size(), std::vector<long double>(held.size()));
    for (std::size_t i = 0; i < held.size(); ++i)
      for (std::size_t j = 0; j < held.size(); ++j) a[i][j] = all[held[i]][held[j]];
    expect_factor(f, a, 1e-10);
  }
}

TEST_P(Cholesky, RepeatedRowsAreRaisedToTheFloorAndTheSolutionStaysBounded) {
  Matrix a = random_spd(30, 2);
  for (const int copy : {12, 29})
    for (int i = 0; i < 30; ++i) a[copy][i] = a[i][copy] = a[4][i];
  for (const int copy : {12, 29}) a[copy][copy] = a[4][4], a[copy][4] = a[4][copy] = a[4][4];
  a[29][12] = a[12][29] = a[4][4];
  Factor f(30);
  std::fill(f.floor.begin(), f.floor.end(), 1e-6);
  f.load(a);
  EXPECT_EQ(table().cholesky(f.l.data(), 30, f.ld, f.floor.data()), 2);
  EXPECT_DOUBLE_EQ(f.at(12, 12), 1e-3);
  std::vector<double> x(30);
  for (int i = 0; i < 30; ++i) x[i] = static_cast<double>(a[i][4]);
  table().cholesky_solve(f.l.data(), 30, f.ld, x.data());
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(x[i], i == 4 ? 1 : 0, 1e-6) << i;
}

TEST_P(Cholesky, ARaisedPivotEqualsComplianceAddedAtThatRow) {
  Matrix a = random_spd(20, 8);
  for (int i = 0; i < 20; ++i) a[13][i] = a[i][13] = a[2][i];
  a[13][13] = a[2][2], a[13][2] = a[2][13] = a[2][2];
  for (const int n : {20, 13}) {
    Factor f(20);
    std::fill(f.floor.begin(), f.floor.end(), 0.25);
    f.load(leading(a, n));
    int raised = table().cholesky(f.l.data(), n, f.ld, f.floor.data());
    if (n == 13) raised += append(f, a, n, 7);
    EXPECT_EQ(raised, 1);
    Matrix softer = a;
    softer[13][13] += 0.25;
    expect_factor(f, softer, 1e-7);
  }
}

TEST_P(Cholesky, APivotThatIsNotANumberIsCounted) {
  Matrix a = random_spd(5, 1);
  a[3][3] = std::numeric_limits<double>::quiet_NaN();
  Factor f(5);
  f.load(a);
  EXPECT_GE(table().cholesky(f.l.data(), 5, f.ld, f.floor.data()), 1);
}

INSTANTIATE_TEST_SUITE_P(Path, Cholesky, ::testing::ValuesIn(available()), path_name);

}  // namespace
}  // namespace palpate::kernels
