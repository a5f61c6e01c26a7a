#include "common/contact/patch/overlap_normal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.006, kFacing = 0.2;

/// A roof of two slopes, whose ridge is the y axis: 12 degrees down to either side.
const SurfaceMap& roof() {
  static const SurfaceMap map = [] {
    const double far = 0.03, down = far * std::tan(12 * std::numbers::pi / 180);
    SurfaceMap m;
    m.position = {{-far, -far, -down}, {0, -far, 0}, {far, -far, -down},
                  {-far, far, -down},  {0, far, 0},  {far, far, -down}};
    m.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    m.touchable = 6;
    m.node_number = {0, 1, 2, 3, 4, 5};
    m.fixed.assign(6, {false, false, false});
    return m;
  }();
  return map;
}

Vector3d normal_at(const Vector3d& middle) {
  const SmoothSurface surface(roof());
  std::vector<int> all(roof().triangles.size());
  std::iota(all.begin(), all.end(), 0);
  return overlap_normal(surface, all, middle, kRadius, Vector3d::UnitZ(), kFacing);
}

/// The same by a fine grid over one facet.
Vector3d summed(const SmoothSurface& surface, int t, const Vector3d& middle) {
  const Vector3d& n = surface.facet_normal(t);
  const Triangle c = surface.corners(t);
  const double high = n.dot(middle - c[0]), a2 = kRadius * kRadius - std::pow(std::max(high, 0.0), 2);
  const Vector3d foot = middle - high * n;
  constexpr int kCells = 1500;
  double sum = 0;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; i + j < kCells; ++j) {
      const auto at = [&](double shift) {
        const Vector3d p = c[0] + (i + shift) / kCells * (c[1] - c[0]) + (j + shift) / kCells * (c[2] - c[0]);
        return std::pow(std::max(a2 - (p - foot).squaredNorm(), 0.0), 2);
      };
      sum += at(1.0 / 3) + (i + j + 1 < kCells ? at(2.0 / 3) : 0);
    }
  return sum * surface.area(t) / (kCells * kCells) * (n.z() - kFacing) * n;
}

TEST(OverlapNormal, BetweenTheEdgesItIsTheFacetsOwn) {
  const SmoothSurface surface(roof());
  const Vector3d& n = surface.facet_normal(2);
  const Vector3d place = surface.corners(2)[0] + Vector3d(0.018, 0.01, -0.018 * std::tan(12 * std::numbers::pi / 180));
  EXPECT_LT((normal_at(place + 0.5 * kRadius * n).normalized() - n).norm(), 1e-12);
  EXPECT_TRUE(normal_at(place + 1.01 * kRadius * n).isZero(0)) << "above the surface";
}

TEST(OverlapNormal, AgreesWithASumOverTheFacets) {
  const SmoothSurface surface(roof());
  for (const Vector3d& middle :
       {Vector3d(0.002, 0.001, 0.003), Vector3d(-0.004, 0.02, 0.004), Vector3d(0.001, 0, -0.002),
        Vector3d(0.027, -0.027, 0.0), Vector3d(0, 0.0301, 0.002)}) {
    Vector3d sum = Vector3d::Zero();
    for (int t = 0; t < 4; ++t) sum += summed(surface, t, middle);
    EXPECT_LT((normal_at(middle) - sum).norm(), 1e-4 * sum.norm()) << middle.transpose();
  }
}

TEST(OverlapNormal, TurnsEvenlyOverARidge) {
  EXPECT_LT((normal_at({0, 0.001, 0.5 * kRadius}).normalized() - Vector3d::UnitZ()).norm(), 1e-12);
  double before = -std::tan(12 * std::numbers::pi / 180);
  for (double x = -2 * kRadius; x < 2 * kRadius; x += 5e-5) {  // 50 mm/s at 1 kHz
    const Vector3d n = normal_at({x, 0.001, 0.5 * kRadius - std::abs(x) * 0.2}).normalized();
    EXPECT_GE(n.x() / n.z(), before - 1e-9) << x;
    EXPECT_LT(n.x() / n.z(), before + 0.006) << x;
    before = n.x() / n.z();
  }
  EXPECT_NEAR(before, std::tan(12 * std::numbers::pi / 180), 1e-9);
}

}  // namespace
}  // namespace palpate
