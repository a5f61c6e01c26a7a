#include "common/kernels/vector.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

/// Columns that one sweep over the rows takes together.
constexpr int kGroup = 8;

template <class T>
void combine(const T* const* columns, const T* coefficient, int count, std::ptrdiff_t rows, T* out) {
  if (count < kGroup) {
    for (std::ptrdiff_t i = 0; i < rows; ++i) out[i] = 0;
  } else {
    accumulate<T, kGroup, true>(columns, coefficient, 0, rows, out);
  }
  int c = count < kGroup ? 0 : kGroup;
  for (; c + kGroup <= count; c += kGroup) accumulate<T, kGroup, false>(columns + c, coefficient + c, 0, rows, out);
  for (; c + 3 <= count; c += 3) accumulate<T, 3, false>(columns + c, coefficient + c, 0, rows, out);
  for (; c < count; ++c) accumulate<T, 1, false>(columns + c, coefficient + c, 0, rows, out);
}

/// Adds N columns at the listed nodes.
template <int N>
void gather(const double* const* column, const double* weight, const int* nodes, int node_count, double* out) {
  for (int m = 0; m < node_count; ++m) {
    const std::ptrdiff_t row = 3 * static_cast<std::ptrdiff_t>(nodes[m]);
    double x = out[3 * m], y = out[3 * m + 1], z = out[3 * m + 2];
    for (int c = 0; c < N; ++c) {
      const double* p = column[c] + row;
      x += weight[c] * p[0];
      y += weight[c] * p[1];
      z += weight[c] * p[2];
    }
    out[3 * m] = x, out[3 * m + 1] = y, out[3 * m + 2] = z;
  }
}

}  // namespace

void combine_f(const float* const* columns, const float* coefficient, int count, std::ptrdiff_t rows, float* out) {
  combine(columns, coefficient, count, rows, out);
}

void combine_d(const double* const* columns, const double* coefficient, int count, std::ptrdiff_t rows, double* out) {
  combine(columns, coefficient, count, rows, out);
}

void combine_nodes_d(const double* const* columns, const double* coefficient, int count, const int* nodes,
                     int node_count, double* out) {
  for (int i = 0; i < 3 * node_count; ++i) out[i] = 0;
  int c = 0;
  for (; c + 3 <= count; c += 3) gather<3>(columns + c, coefficient + c, nodes, node_count, out);
  for (; c < count; ++c) gather<1>(columns + c, coefficient + c, nodes, node_count, out);
}

}  // namespace palpate::kernels::PALPATE_LEVEL
