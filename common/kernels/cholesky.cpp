#include "common/kernels/vector.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

using Vd = Pack<double>;
constexpr int kWidth = Vector<double>::kWidth;
/// Register block: kColumns columns by kVectors vectors of rows fill the registers of the code path.
constexpr int kColumns = kWidth == 8 ? 8 : 4;
constexpr int kVectors = kWidth == 2 ? 2 : 3;

/// x = A[r.., j..j+N) - L[r.., 0..j) L[j..j+N, 0..j)^T for M vectors of rows from r.
template <int M, int N>
inline void subtract_previous(const double* l, std::ptrdiff_t ld, std::ptrdiff_t r, std::ptrdiff_t j, Vd (&x)[N][M]) {
  for (int c = 0; c < N; ++c)
    for (int m = 0; m < M; ++m) x[c][m] = load(l + (j + c) * ld + r + m * kWidth);
  const double* rows = l + r;
  const double* panel = l + j;
  for (std::ptrdiff_t p = 0; p != j * ld; p += ld) {
    Vd row[M];
    for (int m = 0; m < M; ++m) row[m] = load(rows + p + m * kWidth);
    for (int c = 0; c < N; ++c)
      for (int m = 0; m < M; ++m) x[c][m] -= row[m] * panel[p + c];
  }
}

/// Rows from r of the panel of N columns at j, whose diagonal block is factored: x := x D^-T.
template <int M, int N>
inline void solve_rows(double* l, std::ptrdiff_t ld, std::ptrdiff_t r, std::ptrdiff_t j, const double (&inverse)[N]) {
  Vd x[N][M];
  subtract_previous<M, N>(l, ld, r, j, x);
  for (int c = 0; c < N; ++c) {
    for (int d = 0; d < c; ++d) {
      const double factor = l[(j + d) * ld + j + c];
      for (int m = 0; m < M; ++m) x[c][m] -= x[d][m] * factor;
    }
    for (int m = 0; m < M; ++m) {
      x[c][m] *= inverse[c];
      store(l + (j + c) * ld + r + m * kWidth, x[c][m]);
    }
  }
}

/// Factors the diagonal block of the panel at j. floor[c] belongs to column j + c. Returns the raised pivots.
template <int N>
inline int factor_diagonal(double* l, std::ptrdiff_t ld, std::ptrdiff_t j, const double* floor, double (&inverse)[N]) {
  constexpr int vectors = N < kWidth ? 1 : N / kWidth;
  Vd x[N][vectors];
  subtract_previous<vectors, N>(l, ld, j, j, x);
  double block[N][vectors * kWidth];
  for (int c = 0; c < N; ++c)
    for (int m = 0; m < vectors; ++m) store(&block[c][m * kWidth], x[c][m]);
  int raised = 0;
  for (int c = 0; c < N; ++c) {
    double pivot = block[c][c];
    if (!(pivot >= floor[c])) pivot = floor[c], ++raised;
    block[c][c] = __builtin_sqrt(pivot);
    inverse[c] = 1.0 / block[c][c];
    for (int r = c + 1; r < N; ++r) block[c][r] *= inverse[c];
    for (int d = c + 1; d < N; ++d)
      for (int r = d; r < N; ++r) block[d][r] -= block[c][r] * block[c][d];
    for (int r = c; r < N; ++r) l[(j + c) * ld + j + r] = block[c][r];
  }
  return raised;
}

/// One panel of N columns at j.
template <int N>
inline int factor_panel(double* l, std::ptrdiff_t ld, std::ptrdiff_t j, std::ptrdiff_t n, const double* floor) {
  double inverse[N];
  const int raised = factor_diagonal<N>(l, ld, j, floor + j, inverse);
  std::ptrdiff_t r = j + N;
  for (; r + (kVectors - 1) * kWidth < n; r += kVectors * kWidth) solve_rows<kVectors, N>(l, ld, r, j, inverse);
  for (; r < n; r += kWidth) solve_rows<1, N>(l, ld, r, j, inverse);
  return raised;
}

/// Panels of N columns from column j, as many as fit.
template <int N>
inline int factor_panels(double* l, std::ptrdiff_t ld, std::ptrdiff_t& j, std::ptrdiff_t n, const double* floor) {
  int raised = 0;
  for (; j + N <= n; j += N) raised += factor_panel<N>(l, ld, j, n, floor);
  return raised;
}

}  // namespace

int cholesky(double* a, int n, std::ptrdiff_t ld, const double* floor) {
  std::ptrdiff_t j = 0;
  int raised = factor_panels<kColumns>(a, ld, j, n, floor);
  if (kColumns > 4) raised += factor_panels<4>(a, ld, j, n, floor);
  raised += factor_panels<2>(a, ld, j, n, floor);
  return raised + factor_panels<1>(a, ld, j, n, floor);
}

}  // namespace palpate::kernels::PALPATE_LEVEL
