#pragma once
#include <immintrin.h>

#include "common/kernels/vector.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

/// Four numbers of type T: the entries of one node, or one entry of four elements.
template <class T>
struct Quad {
  typedef T Type __attribute__((vector_size(4 * sizeof(T))));
  typedef T Memory __attribute__((vector_size(4 * sizeof(T)), aligned(alignof(T)), may_alias));
};

template <class T>
using Lanes = typename Quad<T>::Type;

template <class T>
inline Lanes<T> load4(const T* p) {
  return *reinterpret_cast<const typename Quad<T>::Memory*>(p);
}

template <class T>
inline void store4(T* p, Lanes<T> v) {
  *reinterpret_cast<typename Quad<T>::Memory*>(p) = v;
}

template <class T>
inline Lanes<T> all(T value) {
  return Lanes<T>{value, value, value, value};
}

inline Lanes<float> root(Lanes<float> x) {
  return _mm_sqrt_ps(x);
}

inline Lanes<double> root(Lanes<double> x) {
#ifdef __AVX__
  return _mm256_sqrt_pd(x);
#else
  typedef double Half __attribute__((vector_size(16)));
  const Half low = _mm_sqrt_pd(Half{x[0], x[1]}), high = _mm_sqrt_pd(Half{x[2], x[3]});
  return Lanes<double>{low[0], low[1], high[0], high[1]};
#endif
}

/// Rows become columns.
template <class V>
inline void transpose(V (&m)[4]) {
  const V a = __builtin_shufflevector(m[0], m[1], 0, 4, 2, 6);
  const V b = __builtin_shufflevector(m[0], m[1], 1, 5, 3, 7);
  const V c = __builtin_shufflevector(m[2], m[3], 0, 4, 2, 6);
  const V d = __builtin_shufflevector(m[2], m[3], 1, 5, 3, 7);
  m[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  m[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  m[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  m[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

}  // namespace
}  // namespace palpate::kernels::PALPATE_LEVEL
