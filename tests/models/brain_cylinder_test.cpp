#include <gtest/gtest.h>

#include <cmath>

#include "common/describe/csv.hpp"
#include "common/fem/direct.hpp"
#include "common/fem/specimen.hpp"
#include "common/mesh/generators.hpp"
#include "common/models/quasi_static/nonlinear.hpp"

/// TVCG99 sec. 6-1: a cylinder of a brain specimen's size under a press of its top, measured at its top
/// (force) and on the circle at mid-height (radial displacement).
namespace palpate {
namespace {

constexpr double kCylinderRadius = 0.015, kCylinderHeight = 0.013, kDeepest = 0.0039;
constexpr int kSteps = 13;
const Eigen::Vector3d kPress = -Eigen::Vector3d::UnitZ();

struct Press {
  double force = 0;            ///< [N] linear, of the top on the tissue along the press
  std::vector<double> linear;  ///< [m] displacements, three a node
};

class BrainCylinder : public ::testing::TestWithParam<const char*> {
 protected:
  BrainCylinder() {
    body.name = "specimen";
    body.material = {6000, 0.45, 1040};
    const std::string curves = PALPATE_SOURCE_DIR "/scenes/curves/";
    body.nonlinear = Nonlinear{
        MeasuredLaw{curves + GetParam(), curves + "brain_radial.csv", kCylinderRadius, kCylinderHeight, 6, {}, 1}};
  }

  MeasuredLaw& curves() { return std::get<MeasuredLaw>(body.nonlinear->law); }

  /// Holds the bottom's height, one point of it and its turn about the axis.
  void slide_at_the_bottom() {
    const auto on_x_axis = [&](int n) {
      return std::hypot(mesh.nodes[n].x() - kCylinderRadius, mesh.nodes[n].y()) < 1e-9;
    };
    const std::vector<int>& bottom = mesh.groups.at("bottom").nodes;
    const auto rim = std::find_if(bottom.begin(), bottom.end(), on_x_axis);
    ASSERT_NE(rim, bottom.end());
    body.fixed = {{{{}, {}, "bottom"}, {false, false, true}},
                  {{{0}, {}, ""}, {true, true, false}},
                  {{{*rim}, {}, ""}, {false, true, false}}};
  }

  Press press(const StaticProblem& problem, double depth, bool stuck) const {
    std::vector<Constraint> top;
    for (int n : mesh.groups.at("top").nodes) {
      top.push_back(hold(n, 2, -depth));
      if (stuck) top.insert(top.end(), {hold(n, 0, 0), hold(n, 1, 0)});
    }
    const StaticSolution solution = solve_direct(problem, top);
    Press result;
    for (int n : mesh.groups.at("top").nodes) result.force += solution.force[n].dot(kPress);
    for (const Eigen::Vector3d& u : solution.displacement)
      result.linear.insert(result.linear.end(), {u.x(), u.y(), u.z()});
    return result;
  }

  std::vector<int> middle_circle() const {
    std::vector<int> nodes;
    for (int n : mesh.groups.at("side").nodes)
      if (std::abs(mesh.nodes[n].z() - kCylinderHeight / 2) < 1e-6) nodes.push_back(n);
    return nodes;
  }

  std::vector<double> corrected(const QuasiNonlinear& law, const std::vector<double>& linear) const {
    std::vector<double> field(linear.size(), 0.0);
    add_corrected<double>(law, linear, kPress, field);
    keep_held<double>(mesh.groups.at("top").nodes, linear, field);
    return field;
  }

  double outward(const std::vector<double>& field, int n) const { return std::hypot(field[3 * n], field[3 * n + 1]); }

  TetMesh mesh = make_cylinder(kCylinderRadius, kCylinderHeight, 10, 6);
  QuasiStaticSpec body;
};

/// The curve's measured value at a displacement, between its points by straight lines.
double measured(const std::filesystem::path& file, const char* column, double x) {
  const CsvTable table = read_csv(file, {"displacement_m", column});
  for (std::size_t i = 1; i < table.rows.size(); ++i) {
    const auto &a = table.rows[i - 1].values, &b = table.rows[i].values;
    if (x <= b[0] + 1e-12) return a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
  }
  return table.rows.back().values[1];
}

TEST_P(BrainCylinder, FitFollowsTheMeasuredCurves) {
  const QuasiNonlinear law = make_nonlinear(body, Archive{}).at(Eigen::Vector3d::Zero());
  const LinearSlopes linear = sliding_slopes(body.material, kCylinderRadius, kCylinderHeight);
  const double greatest = measured(curves().force_curve, "force_N", kDeepest);
  const double widest = measured(curves().radial_curve, "radial_m", kDeepest);
  for (int i = 1; i <= 40; ++i) {
    const double x = kDeepest * i / 40;
    EXPECT_NEAR(law.force_curve().value(linear.force * x), measured(curves().force_curve, "force_N", x),
                2e-3 * greatest);
    EXPECT_NEAR(law.radial_curve().value(linear.radial * x), measured(curves().radial_curve, "radial_m", x),
                2e-3 * widest);
  }
}

// The state is homogeneous, so two layers suffice. The polygon of 96 sides has 0.07 % less area than the
// circle of the closed form, which the curves steepen to 0.2 % of the force.
TEST_P(BrainCylinder, SlidingEndsReproduceTheFittedCurvesAtEveryStep) {
  mesh = make_cylinder(kCylinderRadius, kCylinderHeight, 16, 2);
  slide_at_the_bottom();
  const QuasiNonlinear law = make_nonlinear(body, Archive{}).at(Eigen::Vector3d::Zero());
  const LinearSlopes linear = sliding_slopes(body.material, kCylinderRadius, kCylinderHeight);
  const StaticProblem problem = make_static_problem(body, mesh);
  ASSERT_EQ(middle_circle().size(), 96u);
  for (int i = 1; i <= kSteps; ++i) {
    const double x = kDeepest * i / kSteps;
    Press p = press(problem, x, false);
    const double force = law.force_curve().value(linear.force * x),
                 radial = law.radial_curve().value(linear.radial * x);
    ASSERT_NEAR(p.force * law.force_scale(p.force), force, 0.005 * force) << x;
    const std::vector<double> shown = corrected(law, p.linear);
    for (int n : middle_circle()) ASSERT_NEAR(outward(shown, n), radial, 0.005 * radial) << x;
  }
}

TEST_P(BrainCylinder, StuckEndsReproduceThemWithTheSlopesOfTheModelItself) {
  body.fixed = {{{{}, {}, "bottom"}, {true, true, true}}};
  curves().specimen_mesh = "specimen.msh";
  const SpecimenSlopes slopes = press_specimen(mesh, body.material);
  Archive archive;
  archive.specimen_force_slope = slopes.force;
  archive.specimen_radial_slope = slopes.radial;
  const QuasiNonlinear law = make_nonlinear(body, archive).at(Eigen::Vector3d::Zero());
  const StaticProblem problem = make_static_problem(body, mesh);
  for (int i = 1; i <= kSteps; ++i) {
    const double x = kDeepest * i / kSteps;
    Press p = press(problem, x, true);
    const double force = law.force_curve().value(slopes.force * x),
                 radial = law.radial_curve().value(slopes.radial * x);
    ASSERT_NEAR(p.force * law.force_scale(p.force), force, 0.005 * force) << x;
    const std::vector<double> shown = corrected(law, p.linear);
    double mean = 0;
    for (int n : middle_circle()) mean += outward(shown, n) / 60;
    ASSERT_NEAR(mean, radial, 0.005 * radial) << x;
  }
}

TEST_P(BrainCylinder, StuckEndsAreNotTheClosedForms) {
  const SpecimenSlopes stuck = press_specimen(mesh, body.material);
  const LinearSlopes sliding = sliding_slopes(body.material, kCylinderRadius, kCylinderHeight);
  EXPECT_GT(stuck.force / sliding.force, 1.3);
}

std::string speed_name(const ::testing::TestParamInfo<const char*>& info) {
  const char* const names[] = {"Fast", "Middling", "Slow"};
  return names[info.index];
}

INSTANTIATE_TEST_SUITE_P(Speeds, BrainCylinder,
                         ::testing::Values("brain_force_500mm_min.csv", "brain_force_5mm_min.csv",
                                           "brain_force_0.005mm_min.csv"),
                         speed_name);

}  // namespace
}  // namespace palpate
