#pragma once
#include "common/kernels/block_rows.hpp"
#include "common/kernels/vector.hpp"

/// Time steps of nodes of eight scalars, for any matrix K that multiply<N>(k, x, product, finish) takes: it forms K x,
/// N scalars of each node, on top of what `product` holds, leaves zero there, and hands each row to
/// finish(place, quads), which may move the row's own x.
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

template <class Matrix, class T>
void first_pass(const Matrix& k, const NodeArrays<T>& nodes, double damping) {
  const T a = static_cast<T>(damping);
  multiply<8>(k, nodes.motion, nodes.product, [&](std::ptrdiff_t at, const Quad<T>(&product)[2]) {
    const Quad<T> inverse_mass = load_quad(nodes.response + at), load = load_quad(nodes.response + at + 4);
    const Quad<T> v1 = load - inverse_mass * product[0] - a * load_quad(nodes.motion + at + 4);
    store_quad(nodes.rates + at, v1);
    store_quad(nodes.rates + at + 4, -(inverse_mass * product[1]) - a * v1);
  });
}

template <class Matrix, class T>
void second_pass(const Matrix& k, const NodeArrays<T>& nodes, double damping, double step) {
  const T a = static_cast<T>(damping), h = static_cast<T>(step), h2 = static_cast<T>(step * step / 2),
          h3 = static_cast<T>(step * step * step / 6), h4 = static_cast<T>(step * step * step * step / 24);
  multiply<8>(k, nodes.rates, nodes.product, [&](std::ptrdiff_t at, const Quad<T>(&product)[2]) {
    const Quad<T> inverse_mass = load_quad(nodes.response + at);
    const Quad<T> v1 = load_quad(nodes.rates + at), v2 = load_quad(nodes.rates + at + 4);
    const Quad<T> v3 = -(inverse_mass * product[0]) - a * v2;
    const Quad<T> v4 = -(inverse_mass * product[1]) - a * v3;
    const Quad<T> u = load_quad(nodes.motion + at), v = load_quad(nodes.motion + at + 4);
    store_quad(nodes.motion + at, u + (h * v + (h2 * v1 + (h3 * v2 + h4 * v3))));
    store_quad(nodes.motion + at + 4, v + (h * v1 + (h2 * v2 + (h3 * v3 + h4 * v4))));
  });
}

template <bool NewVelocity, class Matrix, class T>
void one_pass(const Matrix& k, const NodeArrays<T>& nodes, double damping, double step) {
  const T a = static_cast<T>(damping), h = static_cast<T>(step);
  multiply<4>(k, nodes.motion, nodes.product, [&](std::ptrdiff_t at, const Quad<T>(&product)[1]) {
    const Quad<T> inverse_mass = load_quad(nodes.response + at), load = load_quad(nodes.response + at + 4);
    const Quad<T> before = load_quad(nodes.motion + at + 4);
    const Quad<T> after = before + h * (load - inverse_mass * product[0] - a * before);
    store_quad(nodes.motion + at, load_quad(nodes.motion + at) + h * (NewVelocity ? after : before));
    store_quad(nodes.motion + at + 4, after);
  });
}

}  // namespace
}  // namespace palpate::kernels::PALPATE_LEVEL
