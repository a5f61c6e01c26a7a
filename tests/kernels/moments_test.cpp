#include <array>
#include <cmath>
#include <vector>

#include "tests/kernels/all_paths.hpp"

namespace palpate::kernels {
namespace {

using KernelMoments = EveryPath;
using Triangle = std::array<std::array<double, 3>, 3>;
using Moments = std::array<std::array<std::array<double, 10>, 3>, 3>;

constexpr double kPoisson = 0.45;
constexpr std::array<double, 3> kNormal{0.6, 0, 0.8};

/// Barycentric middles of n^2 equal triangles.
std::vector<std::array<double, 3>> middles(int n) {
  std::vector<std::array<double, 3>> all;
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j)
      for (const int down : {0, 1}) {
        const double a = (i + (1 + down) / 3.0) / n, b = (j + (1 + down) / 3.0) / n;
        if (a + b < 1) all.push_back({a, b, 1 - a - b});
      }
  return all;
}

double area(const Triangle& t) {
  std::array<double, 3> u, v;
  for (int i = 0; i < 3; ++i) u[i] = t[1][i] - t[0][i], v[i] = t[2][i] - t[0][i];
  return 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
}

/// By the definition: the midpoint rule on n^2 parts of each triangle.
Moments by_definition(const Triangle& s, const Triangle& t, int n) {
  Moments sum{};
  const auto points = middles(n);
  const double weight = area(s) * area(t) / (points.size() * points.size());
  for (const auto& x : points)
    for (const auto& y : points) {
      std::array<double, 3> d{};
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 3; ++i) d[i] += x[c] * s[c][i] - y[c] * t[c][i];
      const double r = std::hypot(d[0], d[1], d[2]);
      const double up = d[0] * kNormal[0] + d[1] * kNormal[1] + d[2] * kNormal[2];
      std::array<double, 3> h;
      for (int i = 0; i < 3; ++i) h[i] = d[i] - up * kNormal[i];
      const double k[10] = {(1 - kPoisson) / r, h[0] * h[0], h[1] * h[1], h[2] * h[2], h[0] * h[1],
                            h[0] * h[2],        h[1] * h[2], h[0],        h[1],        h[2]};
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          for (int i = 0; i < 10; ++i)
            sum[a][b][i] += weight * x[a] * y[b] * k[i] * (i == 0 ? 1 : i < 7 ? kPoisson / (r * r * r) : 1 / (r * r));
    }
  return sum;
}

Moments by_kernel(const Table& table, const Triangle& s, const Triangle& t) {
  Moments sum;
  table.kernel_moments(s[0].data(), t[0].data(), kNormal.data(), kPoisson, sum[0][0].data());
  return sum;
}

void expect_near(const Moments& seen, const Moments& exact, double share) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      for (int i = 0; i < 10; ++i)
        EXPECT_NEAR(seen[a][b][i], exact[a][b][i], share * exact[a][b][0]) << a << " " << b << " " << i;
}

constexpr Triangle kTriangle{{{0, 0, 0}, {1, 0.1, 0}, {0.2, 0.9, 0.1}}};

Triangle moved(double x, double y, double z) {
  Triangle t{{{0.1, 0, 0.05}, {0.9, 0.2, 0}, {0, 1, 0}}};
  for (auto& corner : t) corner[0] += x, corner[1] += y, corner[2] += z;
  return t;
}

TEST_P(KernelMoments, AreTheIntegralsOfTheDefinitionFarAndNear) {
  expect_near(by_kernel(table(), kTriangle, moved(5, 1, 0.5)), by_definition(kTriangle, moved(5, 1, 0.5), 12), 1e-3);
  expect_near(by_kernel(table(), kTriangle, moved(1.5, 1, 0.2)), by_definition(kTriangle, moved(1.5, 1, 0.2), 16),
              3e-3);
  expect_near(by_kernel(table(), kTriangle, moved(1.05, -0.1, 0.02)),
              by_definition(kTriangle, moved(1.05, -0.1, 0.02), 24), 1e-2);
}

// Triangles that bend at their common edge, as those of any organ do.
TEST_P(KernelMoments, AreTheIntegralsOfTheDefinitionOverABend) {
  for (const double up : {-0.5, 0.0, 0.3}) {
    const Triangle bent{{{1, 0.1, 0}, {0, 0, 0}, {0.7, -0.8, up}}};
    expect_near(by_kernel(table(), kTriangle, bent), by_definition(kTriangle, bent, 24), 2e-2);
  }
}

TEST_P(KernelMoments, AreThoseOfTheOtherPaths) {
  for (const double x : {0.0, 1.1, 2.5, 4.0})
    expect_near(by_kernel(table(), kTriangle, moved(x, 0, 0.01)),
                by_kernel(*available().front(), kTriangle, moved(x, 0, 0.01)), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Path, KernelMoments, ::testing::ValuesIn(available()), path_name);

}  // namespace
}  // namespace palpate::kernels
