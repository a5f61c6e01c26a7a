#include "common/kernels/lanes.hpp"
#include "common/kernels/quads.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

/// With d = rest + du and l = |d|, the elongation l - l0 = (rest + d).du / (l + l0) has no cancellation. The
/// length gets 1e-10 l0 more (in the root of squares), which is below rounding unless the ends meet: there
/// the force is zero.
template <class T>
void springs(const SpringQuad<T>* quads, int count, const T* u, T* force) {
  using V = Lanes<T>;
  for (const SpringQuad<T>* q = quads; q != quads + count; ++q) {
    V du[4];
    for (int l = 0; l < 4; ++l) du[l] = load4(u + q->entry[1][l]) - load4(u + q->entry[0][l]);
    transpose(du);
    V square = all(T(0)), product = all(T(0)), d[4];
    for (int a = 0; a < 3; ++a) {
      const V rest = load4(q->rest[a]);
      d[a] = rest + du[a];
      square += d[a] * d[a];
      product += (rest + d[a]) * du[a];
    }
    const V rest_length = load4(q->length);
    const V length = root(square + (T(1e-20) * rest_length) * rest_length);
    const V pull = load4(q->stiffness) * product / (length * (length + rest_length));
    for (int a = 0; a < 3; ++a) d[a] *= pull;
    d[3] = all(T(0));
    transpose(d);
    for (int l = 0; l < 4; ++l) {
      T* first = force + q->entry[0][l];
      T* second = force + q->entry[1][l];
      store4(first, load4(first) + d[l]);
      store4(second, load4(second) - d[l]);
    }
  }
}

}  // namespace

void springs_f(const SpringQuad<float>* quads, int count, const float* u, float* force) {
  springs(quads, count, u, force);
}

void springs_d(const SpringQuad<double>* quads, int count, const double* u, double* force) {
  springs(quads, count, u, force);
}

}  // namespace palpate::kernels::PALPATE_LEVEL
