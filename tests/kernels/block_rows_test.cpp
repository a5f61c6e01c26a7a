#include <cmath>
#include <limits>
#include <random>

#include "tests/kernels/all_paths.hpp"

namespace palpate::kernels {
namespace {

/// A random symmetric matrix with block rows that sum to zero, node arrays, and the same in long double.
template <class T>
struct System {
  System(int rows, double density, unsigned seed) : random(seed), rows(rows), begin{0} {
    for (int i = 0; i < rows; ++i) {
      for (int j = i + 1; j < rows; ++j)
        if (0.5 * (1 + number()) < density) column.push_back(j);
      begin.push_back(static_cast<int>(column.size()));
    }
    for (std::size_t k = 0; k < kBlockSize * column.size(); ++k) block.push_back(number());
    block.insert(block.end(), 3, T(7));  // read, never used
    for (auto* array : {&motion, &product, &rates, &response}) array->assign(kNodeWidth * rows, T(0));
    for (int i = 0; i < rows; ++i)
      for (int a : {0, 1, 2, 4, 5, 6}) {
        motion[at(i, a)] = number();
        response[at(i, a)] = number();
        product[at(i, a)] = number();
      }
  }

  T number() { return std::uniform_real_distribution<T>(-1, 1)(random); }
  static std::size_t at(int node, int place) { return static_cast<std::size_t>(kNodeWidth) * node + place; }
  EdgeBlocks<T> blocks() const { return {rows, begin.data(), column.data(), block.data()}; }
  NodeArrays<T> arrays() { return {motion.data(), rates.data(), product.data(), response.data()}; }

  /// product + K x for entries first .. first + 2 of each node.
  std::vector<long double> multiply(const std::vector<T>& x, int first) const {
    std::vector<long double> y(3 * rows);
    for (int i = 0; i < rows; ++i)
      for (int a = 0; a < 3; ++a) y[3 * i + a] = product[at(i, first + a)];
    for (int i = 0; i < rows; ++i)
      for (int e = begin[i]; e < begin[i + 1]; ++e)
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) {
            const int j = column[e];
            const long double k_ab = block[kBlockSize * e + 3 * b + a], k_ba = block[kBlockSize * e + 3 * a + b];
            const long double d = static_cast<long double>(x[at(j, first + b)]) - x[at(i, first + b)];
            y[3 * i + a] += k_ab * d;
            y[3 * j + a] -= k_ba * d;
          }
    return y;
  }

  std::mt19937 random;
  int rows;
  std::vector<int> begin, column;
  std::vector<T> block;
  std::vector<T> motion, product, rates, response;
};

template <class T, class F, class D>
auto of_type(F single, D twice) {
  if constexpr (std::is_same_v<T, float>)
    return single;
  else
    return twice;
}

constexpr double kDamping = 0.7, kStep = 0.3;

template <class T>
void expect_near(T value, long double expected) {
  ASSERT_NEAR(value, static_cast<double>(expected),
              200 * std::numeric_limits<T>::epsilon() * (1 + std::abs(static_cast<double>(expected))));
}

/// Both vectors are as expected, what lies between is untouched, and the products are zero again.
template <class T>
void expect_clean(const System<T>& s) {
  for (int i = 0; i < s.rows; ++i)
    for (int place : {3, 7}) {
      ASSERT_EQ(s.motion[s.at(i, place)], 0);
      ASSERT_EQ(s.rates[s.at(i, place)], 0);
    }
  for (T y : s.product) ASSERT_EQ(y, 0);
}

template <class T>
void check_rk4(const Table& table, System<T> s) {
  auto ku = s.multiply(s.motion, 0), kv = s.multiply(s.motion, 4);
  const std::vector<T> before = s.motion;
  of_type<T>(table.rk4_first_f, table.rk4_first_d)(s.blocks(), s.arrays(), kDamping);
  for (int i = 0; i < s.rows; ++i)
    for (int a = 0; a < 3; ++a) {
      const long double m = s.response[s.at(i, a)], g = s.response[s.at(i, a + 4)], v = before[s.at(i, a + 4)];
      const long double v1 = g - m * ku[3 * i + a] - kDamping * v;
      expect_near(s.rates[s.at(i, a)], v1);
      expect_near(s.rates[s.at(i, a + 4)], -m * kv[3 * i + a] - kDamping * v1);
    }
  EXPECT_EQ(s.motion, before);
  expect_clean(s);

  for (int i = 0; i < s.rows; ++i)
    for (int a : {0, 1, 2, 4, 5, 6}) s.product[s.at(i, a)] = s.number();
  const auto k1 = s.multiply(s.rates, 0), k2 = s.multiply(s.rates, 4);
  of_type<T>(table.rk4_second_f, table.rk4_second_d)(s.blocks(), s.arrays(), kDamping, kStep);
  const long double h = kStep, h2 = h * h / 2, h3 = h * h2 / 3, h4 = h * h3 / 4;
  for (int i = 0; i < s.rows; ++i)
    for (int a = 0; a < 3; ++a) {
      const long double m = s.response[s.at(i, a)], u = before[s.at(i, a)], v = before[s.at(i, a + 4)];
      const long double v1 = s.rates[s.at(i, a)], v2 = s.rates[s.at(i, a + 4)];
      const long double v3 = -m * k1[3 * i + a] - kDamping * v2, v4 = -m * k2[3 * i + a] - kDamping * v3;
      expect_near(s.motion[s.at(i, a)], u + h * v + h2 * v1 + h3 * v2 + h4 * v3);
      expect_near(s.motion[s.at(i, a + 4)], v + h * v1 + h2 * v2 + h3 * v3 + h4 * v4);
    }
  expect_clean(s);
}

template <class T>
void check_euler(const Table& table, System<T> s, bool new_velocity) {
  for (int i = 0; i < s.rows; ++i)
    for (int a : {4, 5, 6}) s.product[s.at(i, a)] = 0;
  const auto ku = s.multiply(s.motion, 0);
  const std::vector<T> before = s.motion;
  if (new_velocity)
    of_type<T>(table.semi_implicit_f, table.semi_implicit_d)(s.blocks(), s.arrays(), kDamping, kStep);
  else
    of_type<T>(table.forward_euler_f, table.forward_euler_d)(s.blocks(), s.arrays(), kDamping, kStep);
  for (int i = 0; i < s.rows; ++i)
    for (int a = 0; a < 3; ++a) {
      const long double u = before[s.at(i, a)], v = before[s.at(i, a + 4)];
      const long double after =
          v + kStep * (s.response[s.at(i, a + 4)] - s.response[s.at(i, a)] * ku[3 * i + a] - kDamping * v);
      expect_near(s.motion[s.at(i, a + 4)], after);
      expect_near(s.motion[s.at(i, a)], u + kStep * (new_velocity ? after : v));
    }
  expect_clean(s);
}

template <class T>
void check_all(const Table& table) {
  for (int rows : {0, 1, 2, 3, 7, 40, 113})
    for (double density : {0.0, 0.1, 0.5, 1.0}) {
      const System<T> system(rows, density, 10 * rows + 1);
      check_rk4(table, system);
      check_euler(table, system, true);
      check_euler(table, system, false);
    }
}

class BlockRows : public EveryPath {};

TEST_P(BlockRows, StepsEqualThePlainSumsInSinglePrecision) {
  check_all<float>(table());
}
TEST_P(BlockRows, StepsEqualThePlainSumsInDoublePrecision) {
  check_all<double>(table());
}

TEST_P(BlockRows, TinyNumbersBecomeZeroWithinAStepAndNowhereElse) {
  System<float> s(2, 0, 1);
  const float tiny = 1e-40f;
  for (auto* array : {&s.motion, &s.response, &s.product}) std::fill(array->begin(), array->end(), 0.0f);
  s.motion[4] = tiny;
  table().semi_implicit_f(s.blocks(), s.arrays(), 0, 0.5);
  EXPECT_EQ(s.motion[0], 0.0f);
  volatile float outside = tiny;
  outside = outside * 0.5f;
  EXPECT_NE(outside, 0.0f);
}

INSTANTIATE_TEST_SUITE_P(Paths, BlockRows, ::testing::ValuesIn(available()), path_name);

}  // namespace
}  // namespace palpate::kernels
