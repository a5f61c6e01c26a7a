#include "common/kernels/vector.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

using Vd = Pack<double>;
constexpr int kWidth = Vector<double>::kWidth;

/// One reflection that turns a row [y, z] so that the pivot's row [l, w] becomes [d, 0], d = sqrt(l^2 + w.w):
/// y' = (l y + w.z) / d and z' = z - w (y + y') / (l + d). No difference of close numbers occurs.
template <int K>
struct Reflection {
  double d, l, w[K], inverse, share[K];

  Reflection() = default;
  Reflection(double l, const double (&row)[K]) : l(l) {
    double square = l * l, others = 0;
    for (int c = 0; c < K; ++c) {
      w[c] = row[c];
      (c % 2 ? square : others) += w[c] * w[c];
    }
    d = __builtin_sqrt(square + others);
    inverse = 1.0 / d;
    const double other = 1.0 / (l + d);
    for (int c = 0; c < K; ++c) share[c] = w[c] * other;
  }

  template <class T>
  T apply(T y, T (&z)[K]) const {
    T product = l * y + w[0] * z[0];
    if constexpr (K > 1) {
      T more = w[1] * z[1];
      for (int c = 2; c < K; ++c) more += w[c] * z[c];
      product += more;
    }
    const T both = y + product * inverse;
    for (int c = 0; c < K; ++c) z[c] -= share[c] * both;
    return product * inverse;
  }
};

/// The last row, at most `row`, at which a vector of an aligned column is aligned too.
inline std::ptrdiff_t aligned_row(std::ptrdiff_t row) {
  return row / kWidth * kWidth;
}

/// P columns from t of the trailing part, which moves from rows and columns first + K to `first`: the P
/// reflections are found on the diagonal block and applied to all rows below in one sweep. The sweep begins a
/// little higher, so that what it stores is aligned; the diagonal block is written after it. Each load runs
/// ahead of the stores that overwrite it, because these go to lower rows.
template <int K, int P>
inline void reflect_columns(double* l, std::ptrdiff_t ld, int first, double* const (&z)[K], int t, int size) {
  const double* from = l + (first + K + t) * ld + first + K;
  double* to = l + (first + t) * ld + first;
  double y[P][P], row[P][K];
  for (int q = 0; q < P; ++q) {
    for (int p = 0; p <= q; ++p) y[p][q] = from[p * ld + t + q];
    for (int c = 0; c < K; ++c) row[q][c] = z[c][t + q];
  }
  Reflection<K> reflection[P];
  for (int p = 0; p < P; ++p) {
    reflection[p] = Reflection<K>(y[p][p], row[p]);
    for (int q = p + 1; q < P; ++q) y[p][q] = reflection[p].apply(y[p][q], row[q]);
  }
  for (std::ptrdiff_t i = aligned_row(first + t + P) - first; i < size; i += kWidth) {
    Vd v[K];
    for (int c = 0; c < K; ++c) v[c] = load(z[c] + i);
    for (int p = 0; p < P; ++p) store(to + p * ld + i, reflection[p].apply(load(from + p * ld + i), v));
    for (int c = 0; c < K; ++c) store(z[c] + i, v[c]);
  }
  for (int p = 0; p < P; ++p) {
    to[p * ld + t + p] = reflection[p].d;
    for (int q = p + 1; q < P; ++q) to[p * ld + t + q] = y[p][q];
  }
}

/// Moves rows [first + K, first + K + size) of a column to `first`, the stores aligned but for the first one,
/// which is done last.
template <int K>
inline void move_rows(double* column, std::ptrdiff_t first, std::ptrdiff_t size) {
  const Vd head = load(column + first + K);
  for (std::ptrdiff_t i = aligned_row(first + kWidth); i < first + size; i += kWidth)
    store(column + i, load(column + i + K));
  store(column + first, head);
}

template <int K>
void remove_rows(double* l, int n, std::ptrdiff_t ld, int first, double* scratch) {
  const int rest = first + K, size = n - rest;
  if (size == 0) return;
  double* z[K];
  for (int c = 0; c < K; ++c) {
    z[c] = scratch + c * ld + first - aligned_row(first);
    __builtin_memcpy(z[c], l + (first + c) * ld + rest, sizeof(double) * size);
  }
  for (int j = 0; j < first; ++j) move_rows<K>(l + j * ld, first, size);
  int t = 0;
  for (; t + 3 <= size; t += 3) reflect_columns<K, 3>(l, ld, first, z, t, size);
  for (; t < size; ++t) reflect_columns<K, 1>(l, ld, first, z, t, size);
}

}  // namespace

void cholesky_remove(double* l, int n, std::ptrdiff_t ld, int first, int k, double* scratch) {
  switch (k) {
    case 1:
      return remove_rows<1>(l, n, ld, first, scratch);
    case 2:
      return remove_rows<2>(l, n, ld, first, scratch);
    case 3:
      return remove_rows<3>(l, n, ld, first, scratch);
    case 4:
      return remove_rows<4>(l, n, ld, first, scratch);
    case 5:
      return remove_rows<5>(l, n, ld, first, scratch);
    case 6:
      return remove_rows<6>(l, n, ld, first, scratch);
    case 7:
      return remove_rows<7>(l, n, ld, first, scratch);
    case 8:
      return remove_rows<8>(l, n, ld, first, scratch);
    case 9:
      return remove_rows<9>(l, n, ld, first, scratch);
  }
}

}  // namespace palpate::kernels::PALPATE_LEVEL
