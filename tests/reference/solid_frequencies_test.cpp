#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/mesh/generators.hpp"
#include "common/models/vibration.hpp"
#include "common/shell/modes.hpp"

/// Frequencies of the linear tetrahedra with lumped masses of which moving tissue is.
namespace palpate {
namespace {

/// [m] of NAFEMS FV52's square plate, 1 m thick (Background to Benchmarks, 1992).
constexpr double kSide = 10, kThickness = 1;

/// Steel, held along z at the four edges of its bottom; the other motions of a rigid body are free.
StaticProblem plate(int cells, int layers) {
  const Eigen::Vector3d size(kSide, kSide, kThickness);
  TetMesh mesh = make_block({0, 0, 0}, size, {cells, cells, layers});
  DofMap dofs(mesh);
  for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
    const Eigen::Vector3d& x = mesh.nodes[n];
    const bool edge = x.x() == 0 || x.x() == kSide || x.y() == 0 || x.y() == kSide;
    if (edge && x.z() == 0) dofs.fix(n, 2);
  }
  dofs.number();
  return {std::move(mesh), {{{.young = 200e9, .poisson = 0.3, .density = 8000}}, {}}, std::move(dofs)};
}

/// [Hz] modes 4 to 10, entered as a property of the running test.
std::vector<double> frequencies(int cells, int layers) {
  const FreeVibration free = vibration_of(plate(cells, layers));
  constexpr int kRigid = 3, kCount = 7;
  const Modes modes = lowest_modes(free.stiffness, free.mass, kRigid + kCount, 1e4);
  std::vector<double> hertz;
  std::string text;
  for (int m = kRigid; m < kRigid + kCount; ++m) {
    hertz.push_back(modes.omega[m] / (2 * std::numbers::pi));
    text += fmt::format("{:.9g} ", hertz.back());
  }
  ::testing::Test::RecordProperty(fmt::format("fv52_n{}", cells), text);
  return hertz;
}

/// Far too high on the mesh of 8 cells, of which finer ones take little.
TEST(SolidFrequencies, OfAThickPlateComeDownSlowly) {
  const double published = 45.897;
  std::vector<double> error;
  for (const auto& [cells, layers] : {std::pair{8, 1}, std::pair{16, 2}, std::pair{32, 4}})
    error.push_back(frequencies(cells, layers)[0] / published - 1);
  for (const double e : error) EXPECT_GT(e, 0);
  EXPECT_GT(error[0], 0.3);
  EXPECT_LT(error[1], error[0] / 2);
  EXPECT_LT(error[2], error[1] / 2);
}

}  // namespace
}  // namespace palpate
