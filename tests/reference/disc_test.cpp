#include <gtest/gtest.h>

#include "tests/reference/disc_case.hpp"

/// The compliance of a fixed-size disc near incompressibility. The run-time mesh is irregular, h = 1/12 and the disc's
/// radius 3 h; what is measured is what a tensor archive gives, (f, C~ f) with the consistent forces f_i = int phi_i t
/// of the disc's traction t on the run-time triangles.
namespace palpate {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> pressing(const std::vector<double>& force) {
  std::vector<Vector3d> load;
  for (double f : force) load.push_back({0, 0, -f});
  return load;
}

std::vector<Vector3d> consistent_load(const TetMesh& mesh) {
  auto force = testing::disc_hats(mesh, {0.5, 0.5});
  const double whole = std::accumulate(force.begin(), force.end(), 0.0);
  for (double& f : force) f /= whole;
  return pressing(force);
}

double run_time_disc(int cells, double poisson, const Offline& offline, SurfaceWeight weight = SurfaceWeight::dual) {
  const auto mesh = testing::make_disc_box(cells);
  auto problem = make_fine_problem(testing::make_body(1, poisson), mesh, offline);
  problem.hats = hat_tractions(problem.space, mesh, weight);
  const auto load = spread_loads(problem, consistent_load(mesh));
  return testing::disc_work(load, solve_fine_loads(problem, load));
}

double plain_disc(int cells, double poisson) {
  const auto mesh = testing::make_disc_box(cells);
  const auto load = consistent_load(mesh);
  return testing::disc_work(load,
                            solve_loads(make_static_problem(testing::make_body(1, poisson), mesh), load).displacement);
}

/// A quarter of the box on a regular mesh, the disc's traction integrated on the fine elements themselves.
double fine_disc(int cells, double poisson) {
  const auto mesh = make_block(Vector3d::Zero(), Vector3d::Constant(0.5), {cells, cells, cells});
  auto body = testing::make_body(1, poisson);
  body.fixed.push_back(testing::fix_group("x0", {true, false, false}));
  body.fixed.push_back(testing::fix_group("y0", {false, true, false}));
  const auto problem = make_fine_problem(body, mesh, {0, FiniteElement::p2, Formulation::locking_free});
  const auto load = bench::disc_loads(problem.space, 0.5, -0.25);
  return 4 * testing::disc_work(load, solve_fine_loads(problem, load));
}

/// Limit of three values at 6, 8 and 12 cells under a h^2 law fitted to them.
double extrapolated(double poisson) {
  Eigen::Matrix<double, 3, 2> law;
  Eigen::Vector3d value;
  const int cells[3] = {6, 8, 12};
  for (int i = 0; i < 3; ++i) {
    law.row(i) << 1, 1.0 / (cells[i] * cells[i]);
    value[i] = fine_disc(cells[i], poisson);
    std::printf("reference, %d cells on half the side: %.5f\n", cells[i], value[i]);
  }
  return (law.transpose() * law).inverse().eval().row(0) * (law.transpose() * value);
}

TEST(Disc, ComplianceNearIncompressibilityIsWithinTwoPercentOfTheReferenceWherePlainLinearElementsAreFarOff) {
  for (double poisson : {0.4999, 0.4999999}) {
    const double reference = extrapolated(poisson), plain = plain_disc(12, poisson);
    std::printf("nu %.7f: reference %.5f, plain %.5f (%.1f %%)\n", poisson, reference, plain,
                100 * (plain / reference - 1));
    EXPECT_LT(plain, 0.35 * reference);
    const double quadratic = run_time_disc(12, poisson, {0, FiniteElement::p2, Formulation::locking_free});
    std::printf("p2 locking_free %.5f (%.2f %%)\n", quadratic, 100 * (quadratic / reference - 1));
    EXPECT_NEAR(quadratic, reference, 0.02 * reference);
    const double smeared =
        run_time_disc(12, poisson, {0, FiniteElement::p2, Formulation::locking_free}, SurfaceWeight::hat);
    std::printf("the same with mere hats %.5f (%.2f %%)\n", smeared, 100 * (smeared / reference - 1));
    EXPECT_LT(smeared, 0.93 * reference) << "why the weights are dual";
    const double linear = run_time_disc(12, poisson, {1, FiniteElement::p1, Formulation::locking_free});
    std::printf("p1 refine 1 locking_free %.5f (%.2f %%)\n", linear, 100 * (linear / reference - 1));
    EXPECT_NEAR(linear, reference, 0.05 * reference);
  }
}

}  // namespace
}  // namespace palpate
