#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/fem/tet_element.hpp"
#include "common/mesh/generators.hpp"
#include "common/models/vibration.hpp"
#include "common/shell/modes.hpp"

/// Frequencies of the tetrahedra with lumped masses of which moving tissue is, linear or with averaged strain.
namespace palpate {
namespace {

/// [m] of NAFEMS FV52's square plate, 1 m thick (Background to Benchmarks, 1992).
constexpr double kSide = 10, kThickness = 1;

/// Steel, held along z at the four edges of its bottom; the other motions of a rigid body are free.
StaticProblem plate(int cells, int layers, TetElement element) {
  const Eigen::Vector3d size(kSide, kSide, kThickness);
  TetMesh mesh = make_block({0, 0, 0}, size, {cells, cells, layers});
  DofMap dofs(mesh);
  for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
    const Eigen::Vector3d& x = mesh.nodes[n];
    const bool edge = x.x() == 0 || x.x() == kSide || x.y() == 0 || x.y() == kSide;
    if (edge && x.z() == 0) dofs.fix(n, 2);
  }
  dofs.number();
  MaterialField materials{{{.young = 200e9, .poisson = 0.3, .density = 8000}}, {}, {}};
  if (element == TetElement::nodal_strain) materials.nodal_strain.assign(mesh.tetrahedra.size(), 1);
  return {std::move(mesh), std::move(materials), std::move(dofs)};
}

/// [Hz] modes 4 to 10, entered as a property of the running test.
std::vector<double> frequencies(int cells, int layers, TetElement element) {
  const FreeVibration free = vibration_of(plate(cells, layers, element));
  constexpr int kRigid = 3, kCount = 7;
  const Modes modes = lowest_modes(free.stiffness, free.mass, kRigid + kCount, 1e4);
  std::vector<double> hertz;
  std::string text;
  for (int m = kRigid; m < kRigid + kCount; ++m) {
    hertz.push_back(modes.omega[m] / (2 * std::numbers::pi));
    text += fmt::format("{:.9g} ", hertz.back());
  }
  ::testing::Test::RecordProperty(fmt::format("fv52_{}_n{}", word_of(element), cells), text);
  return hertz;
}

constexpr double kPublished = 45.897;  // [Hz] of mode 4, by a plate's theory; as a solid 44.6 to 44.8

/// Far too high on the mesh of 8 cells, of which finer ones take little.
TEST(SolidFrequencies, OfAThickPlateComeDownSlowly) {
  std::vector<double> error;
  for (const auto& [cells, layers] : {std::pair{8, 1}, std::pair{16, 2}, std::pair{32, 4}})
    error.push_back(frequencies(cells, layers, TetElement::linear)[0] / kPublished - 1);
  for (const double e : error) EXPECT_GT(e, 0);
  EXPECT_GT(error[0], 0.3);
  EXPECT_LT(error[1], error[0] / 2);
  EXPECT_LT(error[2], error[1] / 2);
}

/// One layer is too few for them as well; two are enough, where linear ones are a fifth too high. On finer meshes the
/// frequency goes on falling: a line that holds a solid gives way without limit.
TEST(SolidFrequencies, OfAThickPlateAreRightWithAveragedStrainAndTwoLayers) {
  const double coarse = frequencies(8, 1, TetElement::nodal_strain)[0] / kPublished;
  EXPECT_GT(coarse, 1.2);
  EXPECT_LT(coarse, 1.35);
  const std::vector<double> two = frequencies(16, 2, TetElement::nodal_strain);
  const double published[] = {45.897, 109.44, 109.44, 167.89, 193.59, 206.19, 206.19};
  for (int m = 0; m < 7; ++m) EXPECT_NEAR(two[m], published[m], 0.06 * published[m]) << m;
  EXPECT_NEAR(two[0], kPublished, 0.03 * kPublished);
  EXPECT_NEAR(frequencies(32, 4, TetElement::nodal_strain)[0], 44.7, 0.05 * 44.7);
}

/// [Hz] of a clamped square beam of ten widths of nearly incompressible tissue, two cells across.
double beam_frequency(TetElement element) {
  TetMesh mesh = make_block({0, 0, 0}, {0.1, 0.01, 0.01}, {20, 2, 2});
  DofMap dofs(mesh);
  for (const int n : mesh.groups.at("x0").nodes)
    for (int axis = 0; axis < 3; ++axis) dofs.fix(n, axis);
  dofs.number();
  MaterialField materials{{{.young = 1e4, .poisson = 0.49, .density = 1000}}, {}, {}};
  if (element == TetElement::nodal_strain) materials.nodal_strain.assign(mesh.tetrahedra.size(), 1);
  const FreeVibration free = vibration_of({std::move(mesh), std::move(materials), std::move(dofs)});
  return lowest_modes(free.stiffness, free.mass, 1).omega[0] / (2 * std::numbers::pi);
}

TEST(SolidFrequencies, OfANearlyIncompressibleBeamAreABeamsWithAveragedStrain) {
  const double inertia = 0.01 * 0.01 / 12, root = 1.8751;  // of the section over its area, Euler and Bernoulli
  const double exact = root * root / (2 * std::numbers::pi * 0.1 * 0.1) * std::sqrt(1e4 * inertia / 1000);
  EXPECT_NEAR(beam_frequency(TetElement::nodal_strain) / exact, 1, 0.04);
  EXPECT_GT(beam_frequency(TetElement::linear) / exact, 1.25) << "linear elements lock";
}

}  // namespace
}  // namespace palpate
