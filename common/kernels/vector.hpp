#pragma once
#include "common/kernels/level.hpp"

#ifndef PALPATE_LEVEL
#error "compiled once per code path: PALPATE_LEVEL names its namespace"
#endif

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

#if defined(__AVX512F__)
constexpr int kBytes = 64;
#elif defined(__AVX2__)
constexpr int kBytes = 32;
#else
constexpr int kBytes = 16;
#endif

/// A full vector of T. The type in memory has T's alignment.
template <class T>
struct Vector {
  typedef T Type __attribute__((vector_size(kBytes)));
  typedef T Memory __attribute__((vector_size(kBytes), aligned(alignof(T)), may_alias));
  static constexpr int kWidth = kBytes / static_cast<int>(sizeof(T));
};

template <class T>
using Pack = typename Vector<T>::Type;

template <class T>
inline Pack<T> load(const T* p) {
  return *reinterpret_cast<const typename Vector<T>::Memory*>(p);
}

template <class T>
inline void store(T* p, Pack<T> v) {
  *reinterpret_cast<typename Vector<T>::Memory*>(p) = v;
}

/// Holds a loaded value in its register where several sums use it; the compiler would load it for each.
template <class V>
inline V in_register(V v) {
  asm("" : "+v"(v));
  return v;
}

/// out[i] += sum over c < N of weight[c] * column[c][i] for begin <= i < end; overwrites out where First.
template <class T, int N, bool First>
inline void accumulate(const T* const* column, const T* weight, std::ptrdiff_t begin, std::ptrdiff_t end, T* out) {
  constexpr int kWidth = Vector<T>::kWidth;
  const T* p[N];
  T w[N];
  for (int c = 0; c < N; ++c) p[c] = column[c], w[c] = weight[c];
  std::ptrdiff_t i = begin;
  for (; i + kWidth <= end; i += kWidth) {
    Pack<T> sum = w[0] * load(p[0] + i);
    for (int c = 1; c < N; ++c) sum += w[c] * load(p[c] + i);
    store(out + i, First ? sum : load(out + i) + sum);
  }
  for (; i < end; ++i) {
    T sum = w[0] * p[0][i];
    for (int c = 1; c < N; ++c) sum += w[c] * p[c][i];
    out[i] = First ? sum : out[i] + sum;
  }
}

}  // namespace
}  // namespace palpate::kernels::PALPATE_LEVEL
