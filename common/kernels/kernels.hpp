#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

/// The hot dense loops, compiled once per vector width and chosen when the program starts. Everything is
/// deterministic for a given code path: same input, same bits.
namespace palpate::kernels {

/// One compiled set. All matrices are column-major with leading dimension ld.
struct Table {
  std::string_view name;  ///< "x86-64", "x86-64-v3" (AVX2, FMA) or "x86-64-v4" (AVX-512)

  /// out[0..rows) = sum over i < count of coefficient[i] * columns[i][0..rows). Single precision.
  void (*combine_f)(const float* const* columns, const float* coefficient, int count, std::ptrdiff_t rows, float* out);
  /// The same in double precision.
  void (*combine_d)(const double* const* columns, const double* coefficient, int count, std::ptrdiff_t rows, double* out);

  /// Lower Cholesky factor in place, n x n. Pivots below floor[i] are raised to it. Returns how many were raised.
  int (*cholesky)(double* a, int n, std::ptrdiff_t ld, const double* floor);
  /// Solves L L^T x = b in place.
  void (*cholesky_solve)(const double* l, int n, std::ptrdiff_t ld, double* x);
  /// Appends k rows (k <= 9) to an n x n factor: `rows` is k x (n+k), row-major with stride `row_stride`, the new
  /// rows of A. Pivots as in cholesky. Returns how many were raised.
  int (*cholesky_append)(double* l, int n, std::ptrdiff_t ld, const double* rows, std::ptrdiff_t row_stride, int k, const double* floor);
  /// Removes rows and columns [first, first+k) of A from its n x n factor, by a positive rank-k update of the trailing part.
  void (*cholesky_remove)(double* l, int n, std::ptrdiff_t ld, int first, int k, double* scratch);
};

/// The code paths that this processor can run, widest last.
std::vector<const Table*> available();

/// The path in use: the widest available, unless $PALPATE_KERNELS or use() named another.
const Table& active();

/// Chooses a path by name. Throws std::runtime_error if this processor or build lacks it.
void use(std::string_view name);

}  // namespace palpate::kernels
