#include "common/kernels/vector.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

using Vd = Pack<double>;
constexpr int kWidth = Vector<double>::kWidth;
/// Columns per step of a substitution.
constexpr int kBlock = 8;
/// Most rows appended at once, as in kernels.hpp.
constexpr int kMaxBlock = 9;

/// Divisions up front, out of the chain of the substitution.
inline void invert_diagonal(const double* l, std::ptrdiff_t ld, int j, double (&inverse)[kBlock]) {
  for (int c = 0; c < kBlock; ++c) inverse[c] = 1.0 / l[(j + c) * ld + j + c];
}

/// out[r][i..] -= sum over c < kBlock of weight[r][c] * column[c * ld + i..], one vector.
template <int K>
inline void subtract_vector(const double* column, std::ptrdiff_t ld, int i, const double (&weight)[K][kBlock],
                            double* const (&out)[K]) {
  Vd rest[K];
  for (int r = 0; r < K; ++r) rest[r] = load(out[r]);
  for (int c = 0; c < kBlock; ++c) {
    const Vd v = in_register(load(column + c * ld + i));
    for (int r = 0; r < K; ++r) rest[r] -= v * weight[r][c];
  }
  for (int r = 0; r < K; ++r) store(out[r], rest[r]);
}

/// x[r][i] -= sum over c < kBlock of weight[r][c] * L[i, j + c] for j + kBlock <= i < n. Where Roomy, whole
/// vectors of x may be written.
template <int K, bool Roomy>
inline void subtract_columns(const double* l, int n, std::ptrdiff_t ld, int j, const double (&weight)[K][kBlock],
                             double* const (&x)[K]) {
  const double* column = l + j * ld;
  double* out[K];
  int i = j + kBlock;
  for (int r = 0; r < K; ++r) out[r] = x[r] + i;
  for (; Roomy ? i < n : i + kWidth <= n; i += kWidth) {
    subtract_vector<K>(column, ld, i, weight, out);
    for (int r = 0; r < K; ++r) out[r] += kWidth;
  }
  if (i >= n) return;
  double last[K][kWidth] = {}, *lasts[K];
  for (int r = 0; r < K; ++r) {
    lasts[r] = last[r];
    for (int m = 0; m < n - i; ++m) last[r][m] = out[r][m];
  }
  subtract_vector<K>(column, ld, i, weight, lasts);
  for (int r = 0; r < K; ++r)
    for (int m = 0; m < n - i; ++m) out[r][m] = last[r][m];
}

/// Solves with the diagonal block at j; v holds the result as well.
template <int K>
inline void solve_diagonal(const double* l, std::ptrdiff_t ld, int j, double (&v)[K][kBlock], double* const (&x)[K]) {
  double inverse[kBlock];
  invert_diagonal(l, ld, j, inverse);
  for (int r = 0; r < K; ++r)
    for (int c = 0; c < kBlock; ++c) v[r][c] = x[r][j + c];
  for (int c = 0; c < kBlock; ++c) {
    const double* column = l + (j + c) * ld + j;
    for (int r = 0; r < K; ++r) v[r][c] *= inverse[c];
    for (int d = c + 1; d < kBlock; ++d)
      for (int r = 0; r < K; ++r) v[r][d] -= column[d] * v[r][c];
  }
  for (int r = 0; r < K; ++r)
    for (int c = 0; c < kBlock; ++c) x[r][j + c] = v[r][c];
}

/// Forward substitution: x := L^-1 x for K right-hand sides.
template <int K, bool Roomy>
void solve_lower(const double* l, int n, std::ptrdiff_t ld, double* const (&x)[K]) {
  int j = 0;
  for (; j + kBlock <= n; j += kBlock) {
    double v[K][kBlock];
    solve_diagonal<K>(l, ld, j, v, x);
    subtract_columns<K, Roomy>(l, n, ld, j, v, x);
  }
  for (; j < n; ++j) {
    const double inverse = 1.0 / l[j * ld + j];
    for (int r = 0; r < K; ++r) {
      const double value = x[r][j] *= inverse;
      for (int i = j + 1; i < n; ++i) x[r][i] -= l[j * ld + i] * value;
    }
  }
}

/// Sum of the lanes, halves first.
inline double sum(Vd v) {
  double lane[kWidth];
  store(lane, v);
  for (int half = kWidth / 2; half > 0; half /= 2)
    for (int i = 0; i < half; ++i) lane[i] += lane[i + half];
  return lane[0];
}

double dot(const double* a, const double* b, int n) {
  Vd part[2] = {};
  int i = 0;
  for (; i + 2 * kWidth <= n; i += 2 * kWidth)
    for (int m = 0; m < 2; ++m) part[m] += load(a + i + m * kWidth) * load(b + i + m * kWidth);
  double total = sum(part[0] + part[1]);
  for (; i < n; ++i) total += a[i] * b[i];
  return total;
}

/// x[j + c] -= L[begin..n, j + c] . x[begin..n) for the kBlock columns from j.
void subtract_dots(const double* l, int n, std::ptrdiff_t ld, int j, int begin, double* x) {
  Vd part[kBlock] = {};
  int i = begin;
  for (; i + kWidth <= n; i += kWidth) {
    const Vd v = load(x + i);
    for (int c = 0; c < kBlock; ++c) part[c] += load(l + (j + c) * ld + i) * v;
  }
  for (int c = 0; c < kBlock; ++c) {
    double total = sum(part[c]);
    for (int r = i; r < n; ++r) total += l[(j + c) * ld + r] * x[r];
    x[j + c] -= total;
  }
}

/// Back substitution: x := L^-T x.
void solve_upper(const double* l, int n, std::ptrdiff_t ld, double* x) {
  int j = n;
  for (; j % kBlock != 0; --j) {
    double total = x[j - 1];
    for (int i = j; i < n; ++i) total -= l[(j - 1) * ld + i] * x[i];
    x[j - 1] = total / l[(j - 1) * ld + j - 1];
  }
  for (j -= kBlock; j >= 0; j -= kBlock) {
    double inverse[kBlock];
    invert_diagonal(l, ld, j, inverse);
    subtract_dots(l, n, ld, j, j + kBlock, x);
    for (int c = kBlock - 1; c >= 0; --c) {
      const double* row = l + j + c;
      x[j + c] *= inverse[c];
      for (int d = 0; d < c; ++d) x[j + d] -= row[(j + d) * ld] * x[j + c];
    }
  }
}

/// Factors the k x k block at (n, n), of which `y` holds the k rows to its left. Returns the raised pivots.
int append_diagonal(double* l, int n, std::ptrdiff_t ld, const double* rows, std::ptrdiff_t row_stride, int k,
                    const double* floor) {
  const double* y = l + n * ld;
  double block[kMaxBlock][kMaxBlock];
  int raised = 0;
  for (int i = 0; i < k; ++i)
    for (int j = 0; j <= i; ++j) {
      double value = rows[i * row_stride + n + j] - dot(y + i * ld, y + j * ld, n);
      for (int p = 0; p < j; ++p) value -= block[i][p] * block[j][p];
      if (i == j && !(value >= floor[i])) value = floor[i], ++raised;
      block[i][j] = i == j ? __builtin_sqrt(value) : value / block[j][j];
    }
  for (int i = 0; i < k; ++i)
    for (int j = 0; j <= i; ++j) l[(n + j) * ld + n + i] = block[i][j];
  return raised;
}

}  // namespace

void cholesky_solve(const double* l, int n, std::ptrdiff_t ld, double* x) {
  solve_lower<1, false>(l, n, ld, {x});
  solve_upper(l, n, ld, x);
}

/// The new rows are solved for side by side in the columns that they open, above the diagonal, then put in
/// place.
int cholesky_append(double* l, int n, std::ptrdiff_t ld, const double* rows, std::ptrdiff_t row_stride, int k,
                    const double* floor) {
  double* y = l + n * ld;
  for (int i = 0; i < k; ++i) __builtin_memcpy(y + i * ld, rows + i * row_stride, sizeof(double) * n);
  int i = 0;
  for (; i + 3 <= k; i += 3) solve_lower<3, true>(l, n, ld, {y + i * ld, y + (i + 1) * ld, y + (i + 2) * ld});
  for (; i < k; ++i) solve_lower<1, true>(l, n, ld, {y + i * ld});
  for (int j = 0; j < n; ++j)
    for (int r = 0; r < k; ++r) l[j * ld + n + r] = y[r * ld + j];
  return append_diagonal(l, n, ld, rows, row_stride, k, floor);
}

}  // namespace palpate::kernels::PALPATE_LEVEL
