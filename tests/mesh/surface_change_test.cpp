#include "common/mesh/surface_change.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "common/mesh/generators.hpp"
#include "common/mesh/surface.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A block's surface under x -> F x + (1, 2, 3) mm.
struct Moved {
  TetMesh mesh = make_block({-0.05, -0.03, -0.02}, {0.05, 0.03, 0.02}, {5, 3, 2});
  SurfaceAtRest rest{mesh.nodes, extract_surface(mesh).triangles};
  std::vector<Eigen::Vector3f> position;

  SurfaceChange by(const Matrix3d& gradient) {
    position.clear();
    for (const Vector3d& x : mesh.nodes) position.emplace_back((gradient * x + 1e-3 * Vector3d(1, 2, 3)).cast<float>());
    return rest.change(position);
  }
};

TEST(SurfaceChange, ARigidMotionIsARotationAlone) {
  Moved block;
  for (const double angle : {0.0, 0.3, 1.2, 2.9}) {
    const SurfaceChange c = block.by(Eigen::AngleAxisd(angle, Vector3d(1, -2, 3).normalized()).toRotationMatrix());
    EXPECT_NEAR(c.stretch, 0, 1e-5);
    EXPECT_NEAR(c.rotation, angle, angle == 0 ? 1e-2 : 1e-4);
    EXPECT_NEAR(c.volume, 0, 1e-5);
  }
}

TEST(SurfaceChange, AStretchIsTheLargestOfItsPrincipalOnesEitherWay) {
  Moved block;
  SurfaceChange c = block.by(Vector3d(1.3, 1.1, 0.95).asDiagonal());
  EXPECT_NEAR(c.stretch, 0.3, 1e-4);
  EXPECT_NEAR(c.volume, 1.3 * 1.1 * 0.95 - 1, 1e-4);
  EXPECT_NEAR(c.rotation, 0, 1e-2);
  c = block.by(Vector3d(1, 1, 0.5).asDiagonal());
  EXPECT_NEAR(c.stretch, 1, 1e-4);
  EXPECT_NEAR(c.volume, -0.5, 1e-4);
}

// What linear elasticity makes of a turn by an angle a: it grows by 1/cos a.
TEST(SurfaceChange, ALinearizedRotationGrows) {
  Moved block;
  const double a = 0.5;
  Matrix3d linear;
  linear << 1, -std::tan(a), 0, std::tan(a), 1, 0, 0, 0, 1;
  const SurfaceChange c = block.by(linear);
  EXPECT_NEAR(c.rotation, a, 1e-4);
  EXPECT_NEAR(c.stretch, 1 / std::cos(a) - 1, 1e-4);
  EXPECT_NEAR(c.volume, 1 / (std::cos(a) * std::cos(a)) - 1, 1e-4);
}

TEST(SurfaceChange, CollapsedTrianglesGiveNumbersAndNothingIsAllocated) {
  Moved block;
  const SurfaceChange c = block.by(Matrix3d::Zero());
  EXPECT_TRUE(std::isfinite(c.stretch) && std::isfinite(c.rotation) && std::isfinite(c.volume));
  const long before = allocations();
  block.rest.change(block.position);
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace palpate
