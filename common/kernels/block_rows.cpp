#include "common/kernels/block_rows.hpp"

#include "common/kernels/vector.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

/// N scalars of a node, 4 or 8, in vectors of at most one register; quads [x y z 0] never straddle two of
/// them.
template <class T, int N>
struct Lanes {
  static constexpr int kFitting = kBytes / static_cast<int>(sizeof(T));
  static constexpr int kWidth = kFitting < 4 ? 4 : kFitting < N ? kFitting : N;
  static constexpr int kParts = N / kWidth;
  typedef T Vector __attribute__((vector_size(kWidth * sizeof(T))));
  typedef T Memory __attribute__((vector_size(kWidth * sizeof(T)), aligned(alignof(T)), may_alias));
};

template <class T>
using Quad = typename Lanes<T, 4>::Vector;

template <class V, class M, class T>
inline V load_as(const T* p) {
  return *reinterpret_cast<const M*>(p);
}

template <class T>
inline Quad<T> load_quad(const T* p) {
  return *reinterpret_cast<const typename Lanes<T, 4>::Memory*>(p);
}

template <class T>
inline void store_quad(T* p, Quad<T> v) {
  *reinterpret_cast<typename Lanes<T, 4>::Memory*>(p) = v;
}

/// The same quad in each quad of a vector.
template <class V, class Q>
inline V repeat(Q q) {
  if constexpr (sizeof(V) == sizeof(Q))
    return q;
  else
    return __builtin_shufflevector(q, q, 0, 1, 2, 3, 0, 1, 2, 3);
}

/// Component A of each quad in all four of its places.
template <int A, class Q, class V>
inline V spread(V v) {
  if constexpr (sizeof(V) == sizeof(Q))
    return __builtin_shufflevector(v, v, A, A, A, A);
  else
    return __builtin_shufflevector(v, v, A, A, A, A, A + 4, A + 4, A + 4, A + 4);
}

/// Rows of the 3x3 block with these columns, quad by quad; the fourth places mean nothing.
template <class Q, class V>
inline void transpose(const V (&c)[3], V (&r)[3]) {
  if constexpr (sizeof(V) == sizeof(Q)) {
    const V low = __builtin_shufflevector(c[0], c[1], 0, 4, 1, 5);
    const V high = __builtin_shufflevector(c[0], c[1], 2, 6, 3, 7);
    r[0] = __builtin_shufflevector(low, c[2], 0, 1, 4, 7);
    r[1] = __builtin_shufflevector(low, c[2], 2, 3, 5, 7);
    r[2] = __builtin_shufflevector(high, c[2], 0, 1, 6, 7);
  } else {
    const V low = __builtin_shufflevector(c[0], c[1], 0, 8, 1, 9, 4, 12, 5, 13);
    const V high = __builtin_shufflevector(c[0], c[1], 2, 10, 3, 11, 6, 14, 7, 15);
    r[0] = __builtin_shufflevector(low, c[2], 0, 1, 8, 11, 4, 5, 12, 15);
    r[1] = __builtin_shufflevector(low, c[2], 2, 3, 9, 11, 6, 7, 13, 15);
    r[2] = __builtin_shufflevector(high, c[2], 0, 1, 10, 11, 4, 5, 14, 15);
  }
}

/// Numbers too small for the normal format count as zero meanwhile: a body that comes to rest would else fall
/// into the slow path of the processor.
class FlushToZero {
 public:
  FlushToZero() { __builtin_ia32_ldmxcsr(before_ | 0x8040u); }
  ~FlushToZero() { __builtin_ia32_ldmxcsr(before_); }

 private:
  unsigned before_ = __builtin_ia32_stmxcsr();
};

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
template <class T, int N, class Finish>
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

template <class T>
void first_pass(const EdgeBlocks<T>& k, const NodeArrays<T>& nodes, double damping) {
  const T a = static_cast<T>(damping);
  multiply<T, 8>(k, nodes.motion, nodes.product, [&](std::ptrdiff_t at, const Quad<T>(&product)[2]) {
    const Quad<T> inverse_mass = load_quad(nodes.response + at), load = load_quad(nodes.response + at + 4);
    const Quad<T> v1 = load - inverse_mass * product[0] - a * load_quad(nodes.motion + at + 4);
    store_quad(nodes.rates + at, v1);
    store_quad(nodes.rates + at + 4, -(inverse_mass * product[1]) - a * v1);
  });
}

template <class T>
void second_pass(const EdgeBlocks<T>& k, const NodeArrays<T>& nodes, double damping, double step) {
  const T a = static_cast<T>(damping), h = static_cast<T>(step), h2 = static_cast<T>(step * step / 2),
          h3 = static_cast<T>(step * step * step / 6), h4 = static_cast<T>(step * step * step * step / 24);
  multiply<T, 8>(k, nodes.rates, nodes.product, [&](std::ptrdiff_t at, const Quad<T>(&product)[2]) {
    const Quad<T> inverse_mass = load_quad(nodes.response + at);
    const Quad<T> v1 = load_quad(nodes.rates + at), v2 = load_quad(nodes.rates + at + 4);
    const Quad<T> v3 = -(inverse_mass * product[0]) - a * v2;
    const Quad<T> v4 = -(inverse_mass * product[1]) - a * v3;
    const Quad<T> u = load_quad(nodes.motion + at), v = load_quad(nodes.motion + at + 4);
    store_quad(nodes.motion + at, u + (h * v + (h2 * v1 + (h3 * v2 + h4 * v3))));
    store_quad(nodes.motion + at + 4, v + (h * v1 + (h2 * v2 + (h3 * v3 + h4 * v4))));
  });
}

template <class T, bool NewVelocity>
void one_pass(const EdgeBlocks<T>& k, const NodeArrays<T>& nodes, double damping, double step) {
  const T a = static_cast<T>(damping), h = static_cast<T>(step);
  multiply<T, 4>(k, nodes.motion, nodes.product, [&](std::ptrdiff_t at, const Quad<T>(&product)[1]) {
    const Quad<T> inverse_mass = load_quad(nodes.response + at), load = load_quad(nodes.response + at + 4);
    const Quad<T> before = load_quad(nodes.motion + at + 4);
    const Quad<T> after = before + h * (load - inverse_mass * product[0] - a * before);
    store_quad(nodes.motion + at, load_quad(nodes.motion + at) + h * (NewVelocity ? after : before));
    store_quad(nodes.motion + at + 4, after);
  });
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
  one_pass<float, true>(k, nodes, damping, step);
}
void semi_implicit_d(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step) {
  one_pass<double, true>(k, nodes, damping, step);
}
void forward_euler_f(const EdgeBlocks<float>& k, const NodeArrays<float>& nodes, double damping, double step) {
  one_pass<float, false>(k, nodes, damping, step);
}
void forward_euler_d(const EdgeBlocks<double>& k, const NodeArrays<double>& nodes, double damping, double step) {
  one_pass<double, false>(k, nodes, damping, step);
}

}  // namespace palpate::kernels::PALPATE_LEVEL
