// A tip that is drawn over the edge of a body at rest: the squares of its patch leave the tissue by and by, those of a
// row together, and the force changes by small steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "bench/touch_block.hpp"
#include "common/fem/linear_contact.hpp"
#include "common/fem/refine_graded.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using bench::kTipRadius;
using Eigen::Vector3d;

constexpr double kStep = 1e-5;  // [m] a tick: 10 mm/s

TetMesh block(double edge) {
  return make_block({edge - 10 * kTipRadius, -5 * kTipRadius, -6 * kTipRadius}, {edge, 5 * kTipRadius, 0}, {5, 5, 3});
}

struct Drawn {
  double force = 0, change = 0;  ///< [N] at most, and from tick to tick
  int returns = 0;               ///< ticks in which it touches where it did not a tick ago, but for the first
};

/// Over a rim at x = 0 that it is led across, pressed at one radius before it.
Drawn draw_over(const TetMesh& mesh, double depth, double beside, double friction, double turn = 0) {
  const QuasiStaticSpec spec = bench::touch_block();
  Scene scene = bench::touch_scene(spec, friction);
  scene.tools[0].up = {std::cos(turn), std::sin(turn), 0};
  PressRig rig(scene, {precompute(spec, mesh)});
  const auto middle = [&](double x, double deep) { return Vector3d(x, beside, kTipRadius - deep); };
  rig.start(middle(-kTipRadius, -1e-4));
  for (int k = 1; k <= 200; ++k) rig.press(middle(-kTipRadius, depth * k / 200));
  Drawn drawn;
  Vector3d last = rig.force();
  for (double x = -kTipRadius; x < 1.3 * kTipRadius; x += kStep) {
    rig.press(middle(x, depth));
    const Vector3d now = rig.force();
    drawn.force = std::max(drawn.force, now.norm());
    drawn.change = std::max(drawn.change, (now - last).norm());
    drawn.returns += last.norm() == 0 && now.norm() > 0;
    last = now;
  }
  fmt::print("{:.4f} N at most, changes by {:.5f} N in a tick at most, comes back {} times\n", drawn.force,
             drawn.change, drawn.returns);
  return drawn;
}

TEST(PatchOverARim, ChangesItsForceBySmallSteps) {
  const TetMesh mesh = block(0);
  for (const double depth : {0.1, 0.5, 0.8})
    for (const double turn : {0.0, 0.6}) {
      const Drawn drawn = draw_over(mesh, depth * kTipRadius, 0.2 * kTipRadius, 0, turn);
      EXPECT_LT(drawn.change, 0.008 * drawn.force) << depth << ' ' << turn;
    }
  const Drawn rubbed = draw_over(mesh, 0.5 * kTipRadius, 0.2 * kTipRadius, 0.3);
  EXPECT_LT(rubbed.change, 0.008 * rubbed.force);
}

TEST(PatchOverARim, OfACornerLikewise) {
  const Drawn drawn = draw_over(block(0), 0.5 * kTipRadius, 4.6 * kTipRadius, 0);
  EXPECT_LT(drawn.change, 0.008 * drawn.force);
}

// A side that leans so that the patch looks at it by and by, as its normal turns.
TEST(PatchOverARim, OfASideThatLeansLikewise) {
  for (const double lean : {0.1, 0.2, 0.25, 0.3}) {
    TetMesh mesh = block(0);
    for (Vector3d& x : mesh.nodes) x.x() -= lean * x.z() * (1 + x.x() / (10 * kTipRadius));
    for (const double depth : {0.2, 0.5, 0.8}) {
      const Drawn drawn = draw_over(mesh, depth * kTipRadius, 0.2 * kTipRadius, 0);
      EXPECT_LT(drawn.change, 0.016 * drawn.force) << lean << ' ' << depth;
      EXPECT_LE(drawn.returns, 2) << lean << ' ' << depth << ": off one side and onto the next";
    }
  }
}

// Along the normal of the side that it presses, and across it, as the ball's flanks lean.
TEST(PatchOverARim, ForceIsNearThatOfAConvergedSolution) {
  const QuasiStaticSpec spec = bench::touch_block();
  const TetMesh mesh = block(0);
  PressRig rig(bench::touch_scene(spec, 0), {precompute(spec, mesh)});
  const double depth = 0.5 * kTipRadius;
  for (const double x : {-1.0, -0.5, 0.0}) {
    const Vector3d middle(x * kTipRadius, 0.2 * kTipRadius, kTipRadius - depth), foot(middle.x(), middle.y(), 0);
    const PressedSpot spot{foot, -Vector3d::UnitZ(), kTipRadius};
    int strides = 0;
    const LinearContact reference(
        refine_under_ball(make_static_problem(spec, mesh), std::array{spot}, {1, 1 / 3.0, 0.7, 6000}, strides),
        std::array{foot}, 1.2 * kTipRadius, FiniteElement::p2);
    rig.start(Vector3d(middle + Vector3d(0, 0, depth + 1e-4)));
    for (int k = 1; k <= 200; ++k) rig.press(Vector3d(middle + Vector3d(0, 0, depth * (1 - k / 200.0))));
    const Vector3d truth = reference.press({middle, kTipRadius}).force;
    fmt::print("{:.2f} radii before the rim: {:.4f} N, across {:.4f} N; converged {:.4f} N, {:.4f} N\n", -x,
               rig.force().z(), rig.force().x(), truth.z(), truth.x());
    EXPECT_NEAR(rig.force().z(), truth.z(), 0.13 * truth.norm()) << x;
  }
}

}  // namespace
}  // namespace palpate
