#include "common/kernels/lanes.hpp"
#include "common/kernels/quads.hpp"

namespace palpate::kernels::PALPATE_LEVEL {
namespace {

/// Below this share x of lambda^3 the closed form of the rotation, whose error grows as 1/x^2, loses too many
/// digits.
template <class T>
constexpr T kDegenerate = sizeof(T) == 4 ? T(2e-2) : T(1e-3);

inline double scalar_root(double x) {
  return _mm_cvtsd_f64(_mm_sqrt_pd(_mm_set1_pd(x)));
}

/// One Jacobi rotation that zeroes a[p][q] of a symmetric 4 x 4 matrix; v collects the rotations.
inline void rotate_out(double (&a)[4][4], double (&v)[4][4], int p, int q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double size = theta < 0 ? -theta : theta;
  const double t = (theta < 0 ? -1 : 1) / (size + scalar_root(size * size + 1));
  const double c = 1 / scalar_root(t * t + 1), s = t * c;
  for (int k = 0; k < 4; ++k) {
    const double x = a[k][p], y = a[k][q];
    a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
  }
  for (int k = 0; k < 4; ++k) {
    const double x = a[p][k], y = a[q][k];
    a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
  }
  for (int k = 0; k < 4; ++k) {
    const double x = v[k][p], y = v[k][q];
    v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
  }
}

/// The rotation nearest to any F, flat, inverted and zero ones included: the unit quaternion that belongs to
/// the largest eigenvalue of a symmetric 4 x 4 matrix (Horn 1987, Closed-form solution of absolute
/// orientation using unit quaternions, J. Opt. Soc. Am. A 4).
inline void nearest_rotation(const double (&f)[3][3], double (&r)[3][3]) {
  double a[4][4] = {{f[0][0] + f[1][1] + f[2][2], f[2][1] - f[1][2], f[0][2] - f[2][0], f[1][0] - f[0][1]},
                    {0, f[0][0] - f[1][1] - f[2][2], f[0][1] + f[1][0], f[2][0] + f[0][2]},
                    {0, 0, f[1][1] - f[0][0] - f[2][2], f[1][2] + f[2][1]},
                    {0, 0, 0, f[2][2] - f[0][0] - f[1][1]}};
  double v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) a[i][j] = a[j][i];
  for (int sweep = 0; sweep < 10; ++sweep)
    for (int p = 0; p < 3; ++p)
      for (int q = p + 1; q < 4; ++q) rotate_out(a, v, p, q);
  int best = 0;
  for (int k = 1; k < 4; ++k)
    if (a[k][k] > a[best][best]) best = k;
  const double w = v[0][best], x = v[1][best], y = v[2][best], z = v[3][best];
  r[0][0] = w * w + x * x - y * y - z * z, r[0][1] = 2 * (x * y - w * z), r[0][2] = 2 * (x * z + w * y);
  r[1][0] = 2 * (x * y + w * z), r[1][1] = w * w - x * x + y * y - z * z, r[1][2] = 2 * (y * z - w * x);
  r[2][0] = 2 * (x * z - w * y), r[2][1] = 2 * (y * z + w * x), r[2][2] = w * w - x * x - y * y + z * z;
}

template <class T>
void repair_lane(const Lanes<T> (&f)[3][3], int lane, Lanes<T> (&r)[3][3], Lanes<T>& trace) {
  double from[3][3], to[3][3], sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) from[i][j] = f[i][j][lane];
  nearest_rotation(from, to);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r[i][j][lane] = static_cast<T>(to[i][j]), sum += to[i][j] * from[i][j];
  trace[lane] = static_cast<T>(sum);
}

/// R = d lambda / dF, where lambda = tr(R^T F) is the largest root of
///   x^4 - 2 |F|^2 x^2 - 8 det(F) x + |F|^4 - 4 |cof F|^2 = 0,
/// whose roots are the sums s1 + s2 + s3 of the singular values with an even number of signs changed.
/// Newton's method descends to it from sqrt(3) |F|. The denominator is 2 (s1 + s2)(s2 + s3)(s3 + s1) with s3
/// negative where F inverts.
template <class T>
inline void polar(const Lanes<T> (&f)[3][3], Lanes<T> (&r)[3][3], Lanes<T>& trace) {
  using V = Lanes<T>;
  V cofactor[3][3], gram[3][3], square = all(T(0)), area = all(T(0)), det = all(T(0));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      cofactor[i][j] = f[i1][j1] * f[i2][j2] - f[i1][j2] * f[i2][j1];
      square += f[i][j] * f[i][j];
      area += cofactor[i][j] * cofactor[i][j];
    }
  for (int j = 0; j < 3; ++j) det += f[0][j] * cofactor[0][j];
  const V constant = square * square - T(4) * area;
  // A lane that has arrived stays, so that it does not depend on the other three.
  V x = root(T(3) * square), slope;
  auto moving = x == x;
  for (int step = 0; step < 20; ++step) {
    const V xx = x * x;
    slope = x * (xx - square) - T(2) * det;
    const V value = xx * (xx - T(2) * square) - T(8) * det * x + constant;
    const V change = T(0.25) * value / slope;
    x = moving ? x - change : x;
    moving &= change * change > (T(sizeof(T) == 4 ? 1e-13 : 1e-24) * x) * x;
    if (!(moving[0] | moving[1] | moving[2] | moving[3])) break;
  }
  slope = x * (x * x - square) - T(2) * det;
  const V inverse = T(1) / slope, own = (x * x + square) * inverse, cross = T(2) * x * inverse;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      gram[i][j] = f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j];
      gram[j][i] = gram[i][j];
    }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const V cube = f[i][0] * gram[0][j] + f[i][1] * gram[1][j] + f[i][2] * gram[2][j];
      r[i][j] = own * f[i][j] + cross * cofactor[i][j] - T(2) * inverse * cube;
    }
  trace = x;
  const auto sound = slope > kDegenerate<T> * x * x * x;
  if (sound[0] & sound[1] & sound[2] & sound[3]) return;
  for (int lane = 0; lane < 4; ++lane)
    if (!sound[lane]) repair_lane<T>(f, lane, r, trace);
}

/// Adds -V P g_j to corner j, P = 2 mu (F - R) + lambda tr(R^T F - I) R.
template <class T>
void corotated(const TetQuad<T>* quads, int count, const T* u, T* force) {
  using V = Lanes<T>;
  for (const TetQuad<T>* q = quads; q != quads + count; ++q) {
    V f[3][3], r[3][3], trace;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) f[i][j] = all(T(i == j));
    for (int corner = 1; corner < 4; ++corner) {
      V du[4];
      for (int l = 0; l < 4; ++l) du[l] = load4(u + q->entry[corner][l]) - load4(u + q->entry[0][l]);
      transpose(du);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) f[i][j] += du[i] * load4(q->gradient[corner - 1][j]);
    }
    polar<T>(f, r, trace);
    const V shear = load4(q->shear), pressure = load4(q->volume) * (trace - T(3)) - shear;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) f[i][j] = shear * f[i][j] + pressure * r[i][j];
    V part[4][4] = {};
    for (int corner = 1; corner < 4; ++corner) {
      const auto& gradient = q->gradient[corner - 1];
      for (int i = 0; i < 3; ++i) {
        const V pull = f[i][0] * load4(gradient[0]) + f[i][1] * load4(gradient[1]) + f[i][2] * load4(gradient[2]);
        part[corner][i] = -pull;
        part[0][i] += pull;
      }
    }
    for (auto& corner : part) transpose(corner);
    // Element by element: a node's sum then does not depend on which of them share a quad.
    for (int l = 0; l < 4; ++l)
      for (int corner = 0; corner < 4; ++corner) {
        T* node = force + q->entry[corner][l];
        store4(node, load4(node) + part[corner][l]);
      }
  }
}

}  // namespace

void corotated_f(const TetQuad<float>* quads, int count, const float* u, float* force) {
  corotated(quads, count, u, force);
}

void corotated_d(const TetQuad<double>* quads, int count, const double* u, double* force) {
  corotated(quads, count, u, force);
}

}  // namespace palpate::kernels::PALPATE_LEVEL
