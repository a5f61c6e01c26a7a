#include "common/mesh/tube.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <map>
#include <numbers>

namespace palpate {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

struct Shown {
  std::vector<Vector3f> positions, normals;
};

Shown show(const TubeSurface& tube, const std::vector<Vector3d>& x) {
  Shown s{std::vector<Vector3f>(tube.vertices()), std::vector<Vector3f>(tube.vertices())};
  tube.place(x, s.positions, s.normals);
  return s;
}

std::vector<Vector3d> helix(int particles, double turn) {
  std::vector<Vector3d> x;
  for (int i = 0; i < particles; ++i) x.emplace_back(0.03 * std::cos(turn * i), 0.03 * std::sin(turn * i), 0.001 * i);
  return x;
}

double volume(const TubeSurface& tube, const Shown& s) {
  double sum = 0;
  for (const auto& t : tube.triangles())
    sum +=
        s.positions[t[0]].cast<double>().cross(s.positions[t[1]].cast<double>()).dot(s.positions[t[2]].cast<double>()) /
        6;
  return sum;
}

TEST(Tube, IsClosedAndLooksOutward) {
  const TubeSurface tube(20, 1e-3, Vector3d::UnitX());
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : tube.triangles())
    for (int k = 0; k < 3; ++k) {
      ASSERT_LT(t[k], tube.vertices());
      ++edges[{t[k], t[(k + 1) % 3]}];
    }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  const Shown s = show(tube, helix(20, 0.1));
  for (const auto& t : tube.triangles()) {
    const Vector3f n =
        (s.positions[t[1]] - s.positions[t[0]]).cross(s.positions[t[2]] - s.positions[t[0]]).normalized();
    for (int k = 0; k < 3; ++k) EXPECT_GT(n.dot(s.normals[t[k]]), 0.8f);
  }
  for (const Vector3f& n : s.normals) EXPECT_NEAR(n.norm(), 1, 1e-5);
}

TEST(Tube, HasTheVolumeOfATubeWithRoundEnds) {
  const TubeSurface tube(21, 2e-3);
  std::vector<Vector3d> x;
  for (int i = 0; i < 21; ++i) x.emplace_back(0.1, 0, 0.003 * i);
  const Shown s = show(tube, x);
  const double pi = std::numbers::pi, expected = pi * 4e-6 * 0.06 + 4.0 / 3 * pi * 8e-9;
  EXPECT_NEAR(volume(tube, s), expected, 0.06 * expected);  // twelve sides have 0.955 of a circle's area
}

TEST(Tube, PassesThroughTheParticlesAtItsRadius) {
  const TubeSurface tube(15, 1.5e-3, Vector3d::UnitY());
  const auto x = helix(15, 0.07);
  const Shown s = show(tube, x);
  for (int i = 0; i < 15; ++i) {
    const int ring = TubeSurface::kCapRings + i * TubeSurface::kRings;
    Vector3f middle = Vector3f::Zero();
    for (int k = 0; k < TubeSurface::kAround; ++k) {
      const Vector3f& p = s.positions[1 + ring * TubeSurface::kAround + k];
      middle += p / TubeSurface::kAround;
      EXPECT_NEAR((p - x[i].cast<float>()).norm(), 1.5e-3, 1e-7);
    }
    EXPECT_LT((middle - x[i].cast<float>()).norm(), 1e-7);
  }
}

TEST(Tube, DoesNotTwistAlongItOrInTime) {
  const int particles = 30;
  const TubeSurface tube(particles, 1e-3, helix(particles, 0.1)[1] - helix(particles, 0.1)[0]);
  std::vector<Vector3f> last;
  for (int frame = 0; frame <= 100; ++frame) {
    const Shown s = show(tube, helix(particles, 0.1 + 0.001 * frame));
    const int rings = (particles - 1) * TubeSurface::kRings + 1;
    for (int r = TubeSurface::kCapRings; r + 1 < TubeSurface::kCapRings + rings; ++r)
      EXPECT_GT(s.normals[1 + r * TubeSurface::kAround].dot(s.normals[1 + (r + 1) * TubeSurface::kAround]), 0.99f);
    for (std::size_t v = 0; v < last.size(); ++v) ASSERT_GT(s.normals[v].dot(last[v]), 0.98f);
    last = s.normals;
  }
}

TEST(Tube, StaysFiniteWhereParticlesCoincide) {
  const TubeSurface tube(6, 1e-3, Vector3d::UnitX());
  const std::vector<Vector3d> x(6, Vector3d(0.1, 0.2, 0.3));
  for (const Vector3f& p : show(tube, x).positions) EXPECT_TRUE(p.allFinite());
}

TEST(Tube, RefusesWhatIsNoTube) {
  EXPECT_THROW(TubeSurface(1, 1e-3, Vector3d::UnitX()), std::runtime_error);
  EXPECT_THROW(TubeSurface(5, 0, Vector3d::UnitX()), std::runtime_error);
  EXPECT_THROW(TubeSurface(5, 1e-3, Vector3d::Zero()), std::runtime_error);
}

}  // namespace
}  // namespace palpate
