#include "common/kernels/patch_rows.hpp"

#include <immintrin.h>

#include "common/kernels/node_steps.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

/// The quad in each quad of a vector.
template <class T, int N>
inline typename Lanes<T, N>::Vector in_each(T a, T b, T c) {
  return repeat<typename Lanes<T, N>::Vector>(Quad<T>{a, b, c, 0});
}

/// The stress of a patch from s = V F, given by columns: entry 0 .. 2 of quad c is ds_c.
template <class T, int N>
inline void to_stress(const T* modulus, typename Lanes<T, N>::Vector (&s)[3]) {
  using V = typename Lanes<T, N>::Vector;
  V turned[3];
  transpose<Quad<T>>(s, turned);
  const V dilation = spread<0, Quad<T>>(s[0]) + spread<1, Quad<T>>(s[1]) + spread<2, Quad<T>>(s[2]);
  const V pressure = modulus[0] * dilation;
  const T one = 1, none = 0;
  s[0] = modulus[1] * (s[0] + turned[0]) - modulus[2] * s[0] + pressure * in_each<T, N>(one, none, none);
  s[1] = modulus[1] * (s[1] + turned[1]) - modulus[2] * s[1] + pressure * in_each<T, N>(none, one, none);
  s[2] = modulus[1] * (s[2] + turned[2]) - modulus[2] * s[2] + pressure * in_each<T, N>(none, none, one);
}

/// Number C of four times a vector. Eight floats: every other number from one load of all four, so that neither loads
/// nor shuffles wait.
template <int C, class V, class T>
inline V times(const T* four, V v) {
#ifdef __AVX__
  if constexpr (sizeof(V) == 32 && sizeof(T) == 4 && C % 2 == 1)
    return spread<C, Quad<T>>(reinterpret_cast<V>(_mm256_broadcast_ps(reinterpret_cast<const __m128*>(four)))) * v;
#endif
  return four[C] * v;
}

/// The stresses of all patches, and what the ties do to their own nodes. Ties take turns between two sums, so that none
/// waits for the one before.
template <int N, class T>
inline void take_strains(const PatchRows<T>& k, const T* x, T* product) {
  using V = typename Lanes<T, N>::Vector;
  using M = typename Lanes<T, N>::Memory;
  for (int p = 0; p < k.patches; ++p) {
    const std::ptrdiff_t own = kNodeWidth * static_cast<std::ptrdiff_t>(k.node[p]);
    const V here = load_as<V, M>(x + own);
    V sum[2][4] = {};
    for (int e = k.begin[p]; e < k.begin[p + 1]; e += 2)
      for (int turn = 0; turn < 2; ++turn) {
        const T* tie = k.tie + kTieSize * static_cast<std::ptrdiff_t>(e + turn);
        const V d = load_as<V, M>(x + k.column[e + turn]) - here;
        sum[turn][0] += times<0>(tie, d);
        sum[turn][1] += times<1>(tie, d);
        sum[turn][2] += times<2>(tie, d);
        sum[turn][3] += times<3>(tie, d);
      }
    M& tied = *reinterpret_cast<M*>(product + own);
    tied = tied + (sum[0][3] + sum[1][3]);
    V s[3] = {sum[0][0] + sum[1][0], sum[0][1] + sum[1][1], sum[0][2] + sum[1][2]};
    to_stress<T, N>(k.patch + kTieSize * static_cast<std::ptrdiff_t>(p), s);
    T* stress = k.stress + kStressSize * static_cast<std::ptrdiff_t>(p);
    for (int c = 0; c < 3; ++c) *reinterpret_cast<M*>(stress + kNodeWidth * c) = s[c];
  }
}

/// Row i from the stresses, on top of what the ties have done.
template <int N, class T>
inline typename Lanes<T, N>::Vector take_stresses(const PatchRows<T>& k, const T* stresses, const T* product, int i) {
  using V = typename Lanes<T, N>::Vector;
  using M = typename Lanes<T, N>::Memory;
  V sum[2][3] = {};
  sum[0][0] = load_as<V, M>(product);
  for (int e = k.first[i]; e < k.first[i + 1]; e += 2)
    for (int turn = 0; turn < 2; ++turn) {
      const T* share = k.share + kTieSize * static_cast<std::ptrdiff_t>(e + turn);
      const T* stress = stresses + k.member[e + turn];
      sum[turn][0] += times<0>(share, load_as<V, M>(stress));
      sum[turn][1] += times<1>(share, load_as<V, M>(stress + kNodeWidth));
      sum[turn][2] += times<2>(share, load_as<V, M>(stress + 2 * kNodeWidth));
    }
  return (sum[0][0] + sum[1][0]) + (sum[0][1] + sum[1][1]) + (sum[0][2] + sum[1][2]);
}

template <int N, class T, class Finish>
inline void multiply(const PatchRows<T>& k, const T* x, T* product, Finish finish) {
  using L = Lanes<T, N>;
  const FlushToZero guard;
  PatchRows<T> part = k;
  for (int shift = 0; shift < N; shift += L::kWidth, part.stress += L::kWidth)
    take_strains<N>(part, x + shift, product + shift);
  for (int i = 0; i < k.rows; ++i) {
    const std::ptrdiff_t at = kNodeWidth * static_cast<std::ptrdiff_t>(i);
    Quad<T> quads[N / 4];
    for (int p = 0; p < L::kParts; ++p) {
      T* y = product + at + p * L::kWidth;
      *reinterpret_cast<typename L::Memory*>(y) = take_stresses<N>(k, k.stress + p * L::kWidth, y, i);
    }
    for (int q = 0; q < N / 4; ++q) {
      quads[q] = load_quad(product + at + 4 * q);
      store_quad(product + at + 4 * q, Quad<T>{});
    }
    finish(at, quads);
  }
}

}  // namespace

void patch_rk4_first_f(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping) {
  first_pass(k, nodes, damping);
}
void patch_rk4_first_d(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping) {
  first_pass(k, nodes, damping);
}
void patch_rk4_second_f(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping, double step) {
  second_pass(k, nodes, damping, step);
}
void patch_rk4_second_d(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping, double step) {
  second_pass(k, nodes, damping, step);
}
void patch_semi_implicit_f(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping, double step) {
  one_pass<true>(k, nodes, damping, step);
}
void patch_semi_implicit_d(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping, double step) {
  one_pass<true>(k, nodes, damping, step);
}
void patch_forward_euler_f(const PatchRows<float>& k, const NodeArrays<float>& nodes, double damping, double step) {
  one_pass<false>(k, nodes, damping, step);
}
void patch_forward_euler_d(const PatchRows<double>& k, const NodeArrays<double>& nodes, double damping, double step) {
  one_pass<false>(k, nodes, damping, step);
}

}  // namespace palpate::kernels::PALPATE_LEVEL
