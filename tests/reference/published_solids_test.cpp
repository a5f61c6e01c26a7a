#include <gtest/gtest.h>

#include "bench/solid_cases.hpp"
#include "bench/solid_patch.hpp"

/// Published solids on coarse meshes; docs/verification.md has the fine ones.
namespace palpate {
namespace {

using namespace bench;

const Offline kP1{}, kP2{0, FiniteElement::p2, Formulation::displacement},
    kFree{0, FiniteElement::p2, Formulation::locking_free},
    kFreeLinear{1, FiniteElement::p1, Formulation::locking_free};

TEST(PublishedSolids, StraightBeamOfMacNealAndHarder) {
  EXPECT_NEAR(straight_beam(2, kP2, 0).value, 3.0e-5, 0.005 * 3.0e-5);
  EXPECT_NEAR(straight_beam(2, kP2, 1).value, 0.1081, 0.01 * 0.1081);
  EXPECT_NEAR(straight_beam(2, kP2, 2).value, 0.4321, 0.01 * 0.4321);
  EXPECT_NEAR(straight_beam(2, kFree, 1).value, 0.1081, 0.03 * 0.1081);
  EXPECT_LT(straight_beam(2, kP1, 1).value, 0.5 * 0.1081) << "linear elements lock in bending";
}

TEST(PublishedSolids, TwistedBeamComesToSaintVenantLessWhatItsClampedRootHolds) {
  EXPECT_NEAR(twist_target(), 0.0341, 0.0001);
  const double coarse = straight_beam_twist(2, kP2).value / twist_target() - 1,
               fine = straight_beam_twist(4, kP2).value / twist_target() - 1;
  EXPECT_LT(std::abs(coarse), 0.06);
  EXPECT_LT(std::abs(fine), 0.01);
  EXPECT_LT(straight_beam_twist(2, kP1).value, 0.5 * twist_target()) << "linear elements lock in torsion";
}

TEST(PublishedSolids, PatchOfMacNealAndHarderIsExactToRoundingInEveryFormulation) {
  for (const auto& offline : {kP1, kP2, kFree, kFreeLinear})
    for (unsigned seed : {1, 2, 3}) {
      const auto errors = solid_patch(offline, 0.25, seed);
      EXPECT_LT(errors.displacement, 100) << word_of(offline.element) << " " << word_of(offline.formulation);
      EXPECT_LT(errors.stress, 1000) << word_of(offline.element) << " " << word_of(offline.formulation);
    }
}

TEST(PublishedSolids, CurvedBeamOfMacNealAndHarder) {
  EXPECT_NEAR(curved_beam(2, kP2, true).value, 0.08734, 0.015 * 0.08734);
  EXPECT_NEAR(curved_beam(2, kP2, false).value, 0.5022, 0.03 * 0.5022);
}

TEST(PublishedSolids, CooksMembrane) {
  EXPECT_NEAR(cooks_membrane(8, kP2).value, 23.96, 0.005 * 23.96);
  EXPECT_NEAR(cooks_membrane(8, kFree).value, 23.96, 0.005 * 23.96);
  EXPECT_NEAR(cooks_membrane(8, kFreeLinear).value, 23.96, 0.07 * 23.96);
}

TEST(PublishedSolids, ThickCylinderNearIncompressibilityConvergesAtTheSecondOrderOfItsStraightEdges) {
  for (double poisson : {0.49, 0.499, 0.4999}) {
    const double target = thick_cylinder_target(poisson);
    for (const auto& offline : {kFree, kFreeLinear}) {
      const double coarse = std::abs(thick_cylinder(4, offline, poisson).value / target - 1),
                   fine = std::abs(thick_cylinder(8, offline, poisson).value / target - 1);
      EXPECT_LT(fine, 0.015);
      EXPECT_NEAR(std::log2(coarse / fine), 2, 0.2);
    }
  }
}

TEST(PublishedSolids, ThickEllipticPlateApproachesTheStressOfNafems) {
  const double coarse = nafems_le10(2, kP2).value / -5.38e6 - 1, fine = nafems_le10(4, kP2).value / -5.38e6 - 1;
  EXPECT_LT(std::abs(fine), 0.1);
  EXPECT_LT(std::abs(fine), 0.5 * std::abs(coarse));
}

}  // namespace
}  // namespace palpate
