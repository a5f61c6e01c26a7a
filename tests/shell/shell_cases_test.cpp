// Published cases on meshes that a test has time for; bench_shell_cases goes on to fine ones.
#include "bench/shell_cases.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

using namespace bench;

/// Value over target.
double ratio(ShellCase shell, Bending bending = Bending::discrete_kirchhoff) {
  const double value = solve(shell, bending).value;
  return value / shell.target;
}

TEST(PublishedShells, ScordelisLoRoofComesWithinOnePerCent) {
  EXPECT_NEAR(ratio(scordelis_lo(8, Diagonals::alternating)), 1, 0.01);
  EXPECT_NEAR(ratio(scordelis_lo(8, Diagonals::alike)), 1, 0.01);
}

TEST(PublishedShells, PinchedCylinderConverges) {
  EXPECT_NEAR(ratio(pinched_cylinder(8)), 1, 0.12);
  EXPECT_NEAR(ratio(pinched_cylinder(16)), 1, 0.01);
}

TEST(PublishedShells, PinchedHemisphereConverges) {
  EXPECT_NEAR(ratio(hemisphere(16)), 1, 0.12);
  EXPECT_NEAR(ratio(hemisphere(32)), 1, 0.01);
}

TEST(PublishedShells, TwistedBeamComesWithinOnePerCentOnACoarseMesh) {
  for (bool in_plane : {true, false}) EXPECT_NEAR(ratio(twisted_beam(4, in_plane)), 1, 0.01);
}

TEST(PublishedShells, TwistedThinBeamConverges) {
  for (bool in_plane : {true, false}) EXPECT_NEAR(ratio(twisted_beam(32, in_plane, 0.0032)), 1, 0.01);
}

TEST(PublishedShells, SquarePlateComesWithinOnePerCent) {
  for (bool pressed : {true, false}) EXPECT_NEAR(ratio(square_plate(16, pressed)), 1, 0.002);
}

TEST(PublishedShells, ClampedHyparConverges) {
  EXPECT_NEAR(ratio(clamped_hypar(16)), 1, 0.04);
  EXPECT_NEAR(ratio(clamped_hypar(32)), 1, 0.02);
}

// What docs/shell.md says of the paper's element: it converges, but to another plate.
TEST(PublishedShells, PolynomialElementMakesASquarePlateTooSoftHoweverFineTheMesh) {
  for (int n : {16, 32}) {
    const double soft = ratio(square_plate(n, true, 1, Diagonals::alike), Bending::polynomial);
    EXPECT_GT(soft, 1.37);
    EXPECT_LT(soft, 1.40);
  }
}

}  // namespace
}  // namespace palpate
