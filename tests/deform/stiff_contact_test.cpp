// A ball at rest in tissue, stiff, thin, coarse or of averaged strain, feels a force at rest: it grows with Young's
// modulus and does not chatter.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/mesh/generators.hpp"
#include "tests/deform/block_bench.hpp"

namespace palpate {
namespace {

using testing::Bench;
using testing::block_scene;

struct Held {
  const char* name;
  double young;        ///< [Pa]
  double tip = 0.005;  ///< [m] radius
  double friction = 0;
  Integrator integrator = Integrator::rk4;
  bool slab = false;  ///< cells of 10 x 10 x 1 mm, ten deep, in place of cubes of 10 mm
};

/// [N] mean and rms of the force at a ball that is pressed 2 mm deep off any node within 0.2 s and held, and how far
/// the tissue has moved anywhere [m].
struct Felt {
  double mean = 0, rms = 0, far = 0;
};

Felt hold_in(const Held& held) {
  Scene scene = block_scene();
  MovingSpec& tissue = moving_block_of(scene);
  tissue.material = {held.young, 0.3, 1000};
  tissue.dynamic.damping = 5;
  tissue.dynamic.integrator = held.integrator;
  tissue.dynamic.precision = Precision::float64;
  scene.contact.friction = held.friction;
  std::get<ProbeSpec>(scene.tools[0].end).radius = held.tip;
  const double top = held.slab ? 0.01 : 0.04, half = held.slab ? 0.05 : 0.03;
  Bench bench(scene, held.slab ? make_block({-half, -half, 0}, {half, half, top}, {10, 10, 10})
                               : make_block({-half, -half, 0}, {half, half, top}, {6, 6, 4}));
  Felt felt;
  double sum = 0, squares = 0;
  constexpr int settled = 600, end = 1000;
  for (int i = 0; i < end; ++i) {
    const double t = std::min(1.0, i / 200.0);
    bench.tick(top + held.tip + 0.0005 - 0.0025 * t * t * (3 - 2 * t), 0.0012);
    EXPECT_TRUE(bench.finite()) << held.name << " at tick " << i;
    if (i < settled) continue;
    const double f = -bench.force().z();
    sum += f;
    squares += f * f;
  }
  felt.mean = sum / (end - settled);
  felt.rms = std::sqrt(std::max(0.0, squares / (end - settled) - felt.mean * felt.mean));
  for (int n = 0; n < bench.organ().mesh().nodes(); ++n)
    felt.far = std::max(felt.far, bench.organ().model().displacement(n).norm());
  return felt;
}

class StiffContact : public ::testing::TestWithParam<Held> {};

TEST_P(StiffContact, IsAtRestUnderAToolAtRest) {
  const Felt felt = hold_in(GetParam());
  EXPECT_GT(felt.mean, 0);
  EXPECT_LT(felt.rms, 0.005 * felt.mean);
  EXPECT_LT(felt.far, 0.003);
}

INSTANTIATE_TEST_SUITE_P(Tissue, StiffContact,
                         ::testing::Values(Held{"soft", 2e5}, Held{"stiff", 1e6}, Held{"stiffer", 5e6},
                                           Held{"very_stiff", 1e8, 0.005, 0, Integrator::semi_implicit},
                                           Held{"rough", 5e6, 0.005, 0.3}, Held{"on_nodes", 5e6, 0.012},
                                           Held{"slab", 5e3, 0.005, 0, Integrator::rk4, true},
                                           Held{"slab_on_nodes", 5e3, 0.02, 0, Integrator::rk4, true}),
                         [](const auto& info) { return info.param.name; });

/// Of its force: the largest change in a tick of a slide, and what it swings by when it has stood for a second.
struct Swing {
  double slid = 0, held = 0;
};

/// A tip is pressed 4 mm into the flank of a sagging cylinder, 30 mm from its clamp, slid by 10 mm and held.
Swing slide_over_averaged_cylinder(double friction) {
  Scene scene = block_scene();
  MovingSpec& tissue = moving_block_of(scene);
  tissue.material = {1500, 0.4, 1000};
  tissue.dynamic.element = TetElement::nodal_strain;
  tissue.dynamic.damping = 5;
  tissue.dynamic.gravity = {9.81, 0, 0};
  scene.contact.friction = friction;
  std::get<ProbeSpec>(scene.tools[0].end).radius = 0.005;
  TetMesh lying = make_cylinder(0.015, 0.05, 4, 12);
  for (Eigen::Vector3d& x : lying.nodes) x = {x.z() - 0.03, x.y(), -x.x()};
  Bench bench(scene, lying);
  Swing swing;
  double before = 0, least = std::numeric_limits<double>::infinity(), most = 0;
  constexpr int slides = 1500, stands = 2000, settled = 3000, end = 3500;
  for (int i = 0; i < end; ++i) {
    bench.tick(testing::from_above(i, 500, 0.0205, 0.016),
               testing::from_above(i - slides, stands - slides, 0.0012, -0.0088));
    const double force = bench.force().norm();
    if (i >= slides && i < stands) swing.slid = std::max(swing.slid, std::abs(force - before) / force);
    if (i >= settled) least = std::min(least, force), most = std::max(most, force);
    before = force;
  }
  swing.held = (most - least) / most;
  return swing;
}

/// Its elements are softer than the half-space under forces on single nodes, in shear as well.
TEST(AveragedStrain, IsSlidOverEvenlyAndIsAtRestUnderAToolAtRest) {
  for (const double friction : {0.1, 0.3}) {
    const Swing swing = slide_over_averaged_cylinder(friction);
    EXPECT_LT(swing.slid, 0.03) << friction;
    EXPECT_LT(swing.held, 0.01) << friction;
  }
}

TEST(StiffTissue, TheForceGrowsWithYoungsModulusAlone) {
  const double soft = hold_in({"soft", 2e5}).mean / 2e5;
  EXPECT_NEAR(hold_in({"stiffer", 5e6}).mean / 5e6, soft, 0.002 * soft);
}

}  // namespace
}  // namespace palpate
