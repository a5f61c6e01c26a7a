#include "common/fem/specimen.hpp"

#include <gtest/gtest.h>

#include "common/models/quasi_static/precompute.hpp"
#include "tests/fem/meshes_for_tests.hpp"

namespace palpate {
namespace {

constexpr double kRadius = 0.015, kHeight = 0.013, kYoung = 3000;

TEST(Specimen, WithoutLateralStrainIsAUniaxialBar) {
  const auto slopes = press_specimen(make_cylinder(kRadius, kHeight, 4, 4), {kYoung, 0, 1000});
  // The mesh's cross-section is a polygon of 24 corners.
  const double area = 0.5 * 24 * kRadius * kRadius * std::sin(2 * M_PI / 24);
  EXPECT_NEAR(slopes.force, kYoung * area / kHeight, 1e-9 * slopes.force);
  EXPECT_NEAR(slopes.radial, 0, 1e-10);
}

TEST(Specimen, StuckEndsAreStifferThanFreeOnesAndBulge) {
  double last = 1;
  for (double poisson : {0.3, 0.45, 0.49}) {
    const auto slopes = press_specimen(make_cylinder(kRadius, kHeight, 6, 6), {kYoung, poisson, 1000});
    const double ratio = slopes.force / (kYoung * M_PI * kRadius * kRadius / kHeight);
    EXPECT_GT(ratio, last);
    last = ratio;
    EXPECT_GT(slopes.radial, 0.1);
    EXPECT_LT(slopes.radial, 1);
  }
}

// A body with better tensors than its mesh's answers as the specimen does by such tensors: linear elements of the
// specimen are stiffer, and the curves would be met at the wrong forces.
TEST(Specimen, IsPressedByTheElementsOfTheBody) {
  const auto mesh = make_cylinder(kRadius, kHeight, 4, 4);
  const Material material{kYoung, 0.45, 1000};
  const Offline quadratic{.element = FiniteElement::p2};
  const double linear = press_specimen(mesh, material).force,
               quadratic_force = press_specimen(mesh, material, quadratic).force,
               finer_mesh = press_specimen(make_cylinder(kRadius, kHeight, 6, 6), material).force;
  EXPECT_LT(finer_mesh, linear);
  EXPECT_LT(quadratic_force, finer_mesh);
  EXPECT_GT(quadratic_force, 0.9 * finer_mesh);

  auto body = testing::make_body(kYoung, 0.3);
  body.offline = quadratic;
  const auto archive = precompute(body, testing::make_organ({3, 3, 2}), &mesh);
  EXPECT_EQ(archive.specimen_force_slope, press_specimen(mesh, body.material, quadratic).force);
}

TEST(Specimen, GoesIntoTheArchiveOfABodyThatNamesOne) {
  const auto mesh = testing::make_organ({3, 3, 2});
  const auto specimen = make_cylinder(kRadius, kHeight, 3, 4);
  const auto body = testing::make_body(kYoung, 0.3);
  EXPECT_EQ(precompute(body, mesh).specimen_force_slope, 0);
  const auto archive = precompute(body, mesh, &specimen);
  EXPECT_EQ(archive.specimen_force_slope, press_specimen(specimen, body.material).force);
  EXPECT_GT(archive.specimen_radial_slope, 0);
}

}  // namespace
}  // namespace palpate
