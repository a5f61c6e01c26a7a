#include <gtest/gtest.h>

#include "tests/fem/meshes_for_tests.hpp"
#include "tests/reference/loads.hpp"

/// A quarter of a thick cylinder in plane strain under inner pressure:
///   u_r(r) = (1+nu) p a^2 / (E (b^2-a^2)) ((1-2nu) r + b^2/r).
namespace palpate {
namespace {

constexpr double kInner = 3, kOuter = 9, kPipeYoung = 1000, kPressure = 1, kQuarter = M_PI / 2;

double exact_radial(double poisson, double radius) {
  return (1 + poisson) * kPressure * kInner * kInner / (kPipeYoung * (kOuter * kOuter - kInner * kInner)) *
         ((1 - 2 * poisson) * radius + kOuter * kOuter / radius);
}

/// Half the work of the pressure on a quarter of unit height.
double exact_energy(double poisson) {
  return 0.5 * kPressure * exact_radial(poisson, kInner) * kInner * kQuarter;
}

struct Errors {
  double displacement;  // relative, of the mean radial displacement of the inner face
  double energy;        // relative
};

Errors errors(double poisson, int cells) {
  // A block in (radius, angle, z) bent into the quarter ring; squarish cells.
  auto mesh = make_block({kInner, 0, 0}, {kOuter, kQuarter, 1}, {cells, cells, 1});
  for (auto& node : mesh.nodes) node = {node.x() * std::cos(node.y()), node.x() * std::sin(node.y()), node.z()};
  auto body = testing::make_body(kPipeYoung, poisson);
  body.fixed = {testing::fix_group("y0", {false, true, false}), testing::fix_group("y1", {true, false, false}),
                testing::fix_group("z0", {false, false, true}), testing::fix_group("z1", {false, false, true})};
  const auto inner = [](const Eigen::Vector3d& x) { return x.head<2>().norm() < kInner * (1 + 1e-9); };
  const auto load =
      testing::traction_load(mesh, inner, [](const auto& normal) -> Eigen::Vector3d { return -kPressure * normal; });
  const auto solution = solve_loads(make_static_problem(body, mesh), load);
  double radial = 0;
  int count = 0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    if (!inner(mesh.nodes[i])) continue;
    radial += mesh.nodes[i].head<2>().normalized().dot(solution.displacement[i].head<2>());
    ++count;
  }
  const double energy = 0.5 * testing::work(load, solution.displacement);
  return {std::abs(1 - radial / count / exact_radial(poisson, kInner)), std::abs(1 - energy / exact_energy(poisson))};
}

TEST(ThickCylinder, ClosedFormAgreesWithThePublishedFigures) {
  EXPECT_NEAR(exact_radial(0.3, kInner), 4.5825e-3, 1e-10);
  EXPECT_NEAR(exact_radial(0.49, kInner), 5.0399e-3, 1e-7);
}

TEST(ThickCylinder, DisplacementAndEnergyConvergeAtSecondOrder) {
  for (double poisson : {0.0, 0.3}) {
    const auto coarse = errors(poisson, 8), middle = errors(poisson, 16), fine = errors(poisson, 32);
    SCOPED_TRACE(::testing::Message() << "nu " << poisson << ": displacement " << coarse.displacement << " "
                                      << middle.displacement << " " << fine.displacement << ", energy " << coarse.energy
                                      << " " << middle.energy << " " << fine.energy);
    EXPECT_LT(fine.displacement, 0.005);
    EXPECT_LT(fine.energy, 0.005);
    EXPECT_NEAR(testing::order(coarse.displacement, middle.displacement), 2, 0.35);
    EXPECT_NEAR(testing::order(middle.displacement, fine.displacement), 2, 0.2);
    EXPECT_NEAR(testing::order(middle.energy, fine.energy), 2, 0.2);
  }
}

}  // namespace
}  // namespace palpate
