#include <gtest/gtest.h>

#include "tests/fem/meshes_for_tests.hpp"
#include "tests/reference/loads.hpp"

/// A square beam clamped at x = 0 with a transverse load at its end. With nu = 0 the clamp disturbs nothing
/// but the warping of the section, and the deflection is Timoshenko's, P L^3/(3 E I) + P L/(5/6 G A), to
/// about 0.1 %.
namespace palpate {
namespace {

constexpr double kLength = 5, kYoung = 1000, kLoad = 1;  // of a unit section

double timoshenko() {
  const double inertia = 1.0 / 12, shear_modulus = kYoung / 2;
  return kLoad * std::pow(kLength, 3) / (3 * kYoung * inertia) + kLoad * kLength / (5.0 / 6 * shear_modulus);
}

/// Deflection conjugate to the load: the work of the load over its resultant.
double deflection(int cells) {
  const auto mesh = make_block({0, 0, 0}, {kLength, 1, 1}, {5 * cells, cells, cells});
  auto body = testing::make_body(kYoung, 0);
  body.fixed = {testing::fix_group("x0")};
  const auto load = testing::traction_load(
      mesh, [](const auto& x) { return x.x() > kLength * (1 - 1e-9); },
      [](const auto&) { return Eigen::Vector3d(0, 0, -kLoad); });
  return testing::work(load, solve_loads(make_static_problem(body, mesh), load).displacement) / kLoad;
}

TEST(Cantilever, DeflectionConvergesToTimoshenkoAtSecondOrder) {
  const double exact = timoshenko();
  const double coarse = 1 - deflection(3) / exact, middle = 1 - deflection(6) / exact,
               fine = 1 - deflection(12) / exact;
  RecordProperty("error_3", std::to_string(coarse));
  RecordProperty("error_6", std::to_string(middle));
  RecordProperty("error_12", std::to_string(fine));
  EXPECT_GT(fine, 0) << "displacement elements are too stiff, never too soft";
  EXPECT_LT(fine, 0.04);
  EXPECT_GT(testing::order(coarse, middle), 1.5);
  EXPECT_NEAR(testing::order(middle, fine), 2, 0.2);
}

}  // namespace
}  // namespace palpate
