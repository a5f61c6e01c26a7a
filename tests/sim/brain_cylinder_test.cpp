// TVCG99 fig. 13 through what the nodes run: a plate presses a cylinder of a brain specimen's size in the haptic step,
// and the deformer shows it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/fem/specimen.hpp"
#include "common/mesh/generators.hpp"
#include "common/models/quasi_static/nonlinear.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/sim/simulator.hpp"
#include "tests/sim/played_scenes.hpp"

namespace palpate::sim {
namespace {

using Eigen::Vector3d;

constexpr double kCylinderRadius = 0.015, kCylinderHeight = 0.013, kDeepest = 0.0039;
constexpr double kPlate = 200;  // [m] radius of a ball that is a plate to the cylinder: 0.6 um lower in its middle
constexpr int kRings = 5;       // the top's 91 nodes are all held
constexpr int kSides = 6 * kRings;

class PressedBrainCylinder : public ::testing::TestWithParam<const char*> {
 protected:
  PressedBrainCylinder() {
    body_.name = "specimen";
    body_.material = {6000, 0.45, 1040};
    const std::string curves = PALPATE_SOURCE_DIR "/scenes/curves/";
    body_.nonlinear = Nonlinear{
        MeasuredLaw{curves + GetParam(), curves + "brain_radial.csv", kCylinderRadius, kCylinderHeight, 6, {}, 1}};
    // The bottom slides: its height is held, one point of it, and its turn about the axis.
    const auto on_x_axis = [&](int n) {
      return std::hypot(mesh_.nodes[n].x() - kCylinderRadius, mesh_.nodes[n].y()) < 1e-9;
    };
    const std::vector<int>& bottom = mesh_.groups.at("bottom").nodes;
    const int rim = *std::ranges::find_if(bottom, on_x_axis);
    body_.fixed = {{{{}, {}, "bottom"}, {false, false, true}},
                   {{{0}, {}, ""}, {true, true, false}},
                   {{{rim}, {}, ""}, {false, true, false}}};
    scene_.bodies.push_back(body_);
    scene_.contact.friction = 0;
    Tool plate;
    plate.name = "plate";
    plate.pivot = {0, 0, 2 * kPlate};
    plate.axis = -Vector3d::UnitZ();
    plate.up = Vector3d::UnitY();
    std::get<ProbeSpec>(plate.end).radius = kPlate;
    plate.shaft_length = 0.01;
    plate.max_force = plate.max_force_rate = 1e6;
    scene_.tools.push_back(plate);
    scene_.contact.rule = ContactRule::barycentric;  // a plate is no ball
    archives_.push_back(precompute(body_, mesh_));
  }

  ToolInput at(double depth) const { return {tip_at(scene_.tools[0], {0, 0, kPlate + kCylinderHeight - depth})}; }
  /// [m] mean outward displacement on the circle at mid-height, as it is shown.
  double widening(Simulator& simulator) const {
    const auto shown = simulator.surface(0).position;
    double sum = 0;
    int count = 0;
    for (std::size_t n = 0; n < shown.size(); ++n) {
      const Vector3d& rest = archives_[0].surface.position[n];
      const double r = std::hypot(rest.x(), rest.y());
      if (std::abs(rest.z() - kCylinderHeight / 2) > 1e-6 || r < 0.99 * kCylinderRadius) continue;
      sum += std::hypot(shown[n].x(), shown[n].y()) - r;
      ++count;
    }
    EXPECT_EQ(count, kSides);
    return sum / count;
  }

  TetMesh mesh_ = make_cylinder(kCylinderRadius, kCylinderHeight, kRings, 2);
  QuasiStaticSpec body_;
  Scene scene_;
  std::vector<Archive> archives_;
};

// The polygon has 0.7 % less area than the circle of the closed form, and the linear force with it.
TEST_P(PressedBrainCylinder, GivesTheHandAndTheEyeTheMeasuredCurves) {
  constexpr double turn = 2 * std::numbers::pi / kSides;
  const double area = std::sin(turn) / turn;
  const QuasiNonlinear law = make_nonlinear(body_, archives_[0]).at(Eigen::Vector3d::Zero());
  const LinearSlopes linear = sliding_slopes(body_.material, kCylinderRadius, kCylinderHeight);
  Simulator simulator(scene_, archives_);
  simulator.start(std::array{at(-1e-4)});
  for (int i = 1; i <= 13; ++i) {
    const double x = kDeepest * i / 13;
    for (int settling = 0; settling < 3; ++settling) simulator.step(std::array{at(x)});
    const double force = law.force_curve().value(area * linear.force * x),
                 radial = law.radial_curve().value(linear.radial * x);
    EXPECT_NEAR(simulator.tool(0).force.z(), force, 0.005 * force) << x;
    EXPECT_NEAR(widening(simulator), radial, 0.005 * radial) << x;
  }
}

std::string speed_name(const ::testing::TestParamInfo<const char*>& info) {
  const char* const names[] = {"Fast", "Middling", "Slow"};
  return names[info.index];
}

INSTANTIATE_TEST_SUITE_P(Speeds, PressedBrainCylinder,
                         ::testing::Values("brain_force_500mm_min.csv", "brain_force_5mm_min.csv",
                                           "brain_force_0.005mm_min.csv"),
                         speed_name);

}  // namespace
}  // namespace palpate::sim
