#include "common/kernels/block_rows.hpp"

#include "common/kernels/node_steps.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

/// Row i of K x while it is summed, N scalars of each node.
template <class T, int N>
class Row {
  using L = Lanes<T, N>;
  using V = typename L::Vector;
  using M = typename L::Memory;

 public:
  /// x and y of the row's own node; y holds what others have added.
  Row(const T* x, T* y) : y_(y) {
    for (int p = 0; p < L::kParts; ++p) {
      here_[p] = load_as<V, M>(x + p * L::kWidth);
      sum_[p][0] = load_as<V, M>(y + p * L::kWidth);
      sum_[p][1] = sum_[p][2] = V{};
    }
  }

  /// Adds K_ij (x_j - x_i) to the row and the opposite share, by the transpose, to y_j.
  void add(const T* block, const T* xj, T* yj) {
    V column[3], row[3];
    for (int a = 0; a < 3; ++a) column[a] = repeat<V>(load_quad(block + 3 * a));
    transpose<Quad<T>>(column, row);
    for (int p = 0; p < L::kParts; ++p) {
      const V d = load_as<V, M>(xj + p * L::kWidth) - here_[p];
      const V d0 = spread<0, Quad<T>>(d), d1 = spread<1, Quad<T>>(d), d2 = spread<2, Quad<T>>(d);
      sum_[p][0] += column[0] * d0;
      sum_[p][1] += column[1] * d1;
      sum_[p][2] += column[2] * d2;
      M& other = *reinterpret_cast<M*>(yj + p * L::kWidth);
      other = other - row[0] * d0 - row[1] * d1 - row[2] * d2;
    }
  }

  /// Hands out the sum and leaves zero in y.
  void take(Quad<T> (&quads)[N / 4]) {
    for (int p = 0; p < L::kParts; ++p) {
      const V total = sum_[p][0] + (sum_[p][1] + sum_[p][2]);
      *reinterpret_cast<M*>(y_ + p * L::kWidth) = V{};
      if constexpr (L::kWidth == 4) {
        quads[p] = total;
      } else {
        quads[0] = __builtin_shufflevector(total, total, 0, 1, 2, 3);
        quads[1] = __builtin_shufflevector(total, total, 4, 5, 6, 7);
      }
    }
  }

 private:
  T* y_;
  V here_[L::kParts], sum_[L::kParts][3];
};

/// The same number by number, where no register holds a quad.
template <class T, int N>
class PlainRow {
 public:
  PlainRow(const T* x, T* y) : x_(x), y_(y) {}

  void add(const T* k, const T* xj, T* yj) {
    for (int p = 0; p < N; p += 4) {
      const T d0 = xj[p] - x_[p], d1 = xj[p + 1] - x_[p + 1], d2 = xj[p + 2] - x_[p + 2];
      for (int a = 0; a < 3; ++a) y_[p + a] += k[a] * d0 + k[3 + a] * d1 + k[6 + a] * d2;
      for (int a = 0; a < 3; ++a) yj[p + a] -= k[3 * a] * d0 + k[3 * a + 1] * d1 + k[3 * a + 2] * d2;
    }
  }

  void take(Quad<T> (&quads)[N / 4]) {
    for (int p = 0; p < N; p += 4) quads[p / 4] = Quad<T>{y_[p], y_[p + 1], y_[p + 2], 0};
    for (int p = 0; p < N; ++p) y_[p] = 0;
  }

 private:
  const T* x_;
  T* y_;
};

template <bool Fits, class T, int N>
struct RowType {
  using Type = Row<T, N>;
};
template <class T, int N>
struct RowType<false, T, N> {
  using Type = PlainRow<T, N>;
};

/// Forms K x row by row, N scalars of each node, on top of what `product` holds, and hands each row to
/// finish(place, quads) as soon as it is complete: the rows before have added their share by then, and no
/// later row reads x or the product there.
template <int N, class T, class Finish>
inline void multiply(const EdgeBlocks<T>& k, const T* x, T* product, Finish finish) {
  const FlushToZero guard;
  const T* block = k.block;
  for (int i = 0; i < k.rows; ++i) {
    const std::ptrdiff_t at = kNodeWidth * static_cast<std::ptrdiff_t>(i);
    typename RowType<sizeof(Quad<T>) <= kBytes, T, N>::Type row(x + at, product + at);
    for (int e = k.begin[i]; e < k.begin[i + 1]; ++e, block += kBlockSize) {
      const std::ptrdiff_t other = kNodeWidth * static_cast<std::ptrdiff_t>(k.column[e]);
      row.add(block, x + other, product + other);
    }
    Quad<T> quads[N / 4];
    row.take(quads);
    finish(at, quads);
  }
}

}  // namespace

void rk4_first_f(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping) {
  first_pass(k, nodes, damping);
}
void rk4_first_d(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping) {
  first_pass(k, nodes, damping);
}
void rk4_second_f(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping, double step) {
  second_pass(k, nodes, damping, step);
}
void rk4_second_d(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step) {
  second_pass(k, nodes, damping, step);
}
void semi_implicit_f(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping, double step) {
  one_pass<true>(k, nodes, damping, step);
}
void semi_implicit_d(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step) {
  one_pass<true>(k, nodes, damping, step);
}
void forward_euler_f(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping, double step) {
  one_pass<false>(k, nodes, damping, step);
}
void forward_euler_d(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step) {
  one_pass<false>(k, nodes, damping, step);
}

}  // namespace palpate::kernels::PALPATE_LEVEL
