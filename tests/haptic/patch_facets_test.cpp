// A tip on a body of flat faces: force and shape are those of the body, faces and all, and not those of a rounder one.
#include <gtest/gtest.h>

#include "bench/touch_block.hpp"
#include "common/fem/linear_contact.hpp"
#include "common/fem/refine_graded.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using bench::kTipRadius;
using Eigen::Vector3d;

/// A column of 6 x 6 x 9 radii with a vaulted top of four faces, 12 degrees and 33 degrees down to either side.
TetMesh vaulted_column() {
  constexpr double kHalf = 3 * kTipRadius, kHigh = 9 * kTipRadius;
  TetMesh mesh = make_block({-kHalf, -kHalf, -kHigh}, {kHalf, kHalf, 0}, {4, 3, 5});
  for (Vector3d& x : mesh.nodes) x.z() -= (1 + x.z() / kHigh) * 0.14 / kTipRadius * x.x() * x.x();
  return mesh;
}

TEST(PatchOnFacets, ForceAndShapeAreThoseOfAConvergedSolution) {
  QuasiStaticSpec column = bench::touch_block();
  const TetMesh mesh = vaulted_column();
  const Archive archive = precompute(column, mesh);
  const SurfaceMap& surface = archive.surface;
  // Near the edge between the faces, where a normal that turns from edge to edge leans by 6 degrees.
  const double x = 1.15 * kTipRadius, slope = 0.14 * 1.5;
  const Vector3d point(x, 0.3 * kTipRadius, -slope * x), inward = Vector3d(-slope, 0, -1).normalized();
  int strides = 0;
  const PressedSpot spot{point, inward, kTipRadius};
  const LinearContact reference(
      refine_under_ball(make_static_problem(column, mesh), std::array{spot}, {1, 1 / 3.0, 0.7, 6000}, strides),
      std::array{point}, kTipRadius, FiniteElement::p2);
  PressRig rig(bench::touch_scene(column, 0), {archive});
  const auto centre = [&](double depth) { return Vector3d(point + (depth - kTipRadius) * inward); };
  rig.start(centre(-1e-4));
  for (const double depth : {0.25 * kTipRadius, 0.5 * kTipRadius}) {
    for (int i = 1; i <= 60; ++i) rig.press(centre(depth * i / 60));
    const PressState truth = reference.press({centre(depth), kTipRadius});
    const double force = truth.force.dot(inward);
    EXPECT_NEAR(rig.force().dot(inward), force, 0.03 * force) << depth;
    const std::vector<Vector3d> shown = rig.displacement();
    double off = 0, all = 0;
    for (int n = 0; n < surface.size(); ++n) {
      const Vector3d& u = truth.displacement[surface.node_number[n]];
      off += (shown[n] - u).squaredNorm();
      all += u.squaredNorm();
    }
    EXPECT_LT(std::sqrt(off / all), 0.18) << depth << ": by a normal that turns from edge to edge it is 0.43 and 0.22";
  }
}

}  // namespace
}  // namespace palpate
