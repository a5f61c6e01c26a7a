#include "common/shell/assembly.hpp"

#include <gtest/gtest.h>

#include "common/geometry/dense_solvers.hpp"
#include "common/shell/shell_element.hpp"
#include "tests/shell/irregular_shells.hpp"

namespace palpate {
namespace {

using namespace testing;
using bench::Diagonals;
using bench::shell_grid;

/// Largest force of a rigid motion, over the largest of a motion of the same size that strains the shell.
double rigid_force(const ShellMesh& mesh, Bending bending) {
  const ShellDofs dofs = all_free(mesh);
  const SparseMatrix stiffness = whole_stiffness(mesh, dofs, bending);
  const auto largest = [&](auto&& motion_at) {
    return (stiffness * motion_vector(mesh, dofs, motion_at)).cwiseAbs().maxCoeff();
  };
  double rigid = 0;
  for (int i = 0; i < 6; ++i)
    rigid = std::max(rigid, largest([&](const Eigen::Vector3d& x) -> ShellMotion {
                       const ShellMotion unit = ShellMotion::Unit(i);
                       const Eigen::Vector3d turn = unit.tail<3>();
                       return (ShellMotion() << unit.head<3>() + turn.cross(x), turn).finished();
                     }));
  return rigid / largest([](const Eigen::Vector3d& x) -> ShellMotion {
           return (ShellMotion() << x, Eigen::Vector3d::Zero()).finished();
         });
}

TEST(ShellStiffness, AnswersNoRigidMotionOfAnyShellInAnyOrientation) {
  for (const auto& mesh : {irregular_patch(), bent_tube(), bench::sphere_octant(5, 1)}) {
    EXPECT_LT(rigid_force(mesh, Bending::discrete_kirchhoff), 1e-12);
    EXPECT_LT(rigid_force(turned(mesh, some_turn()), Bending::discrete_kirchhoff), 1e-12);
  }
  EXPECT_LT(rigid_force(turned(irregular_patch(), some_turn()), Bending::polynomial), 1e-10);
  EXPECT_LT(rigid_force(bent_tube(), Bending::polynomial), 1e-10);
}

TEST(ShellStiffness, HoldsRotationsOfACoplanarPatchAndACurvedTube) {
  for (const auto& mesh : {irregular_patch(), turned(irregular_patch(), some_turn()), bent_tube()}) {
    const ShellDofs dofs = all_free(mesh);
    const Eigen::MatrixXd whole = whole_stiffness(mesh, dofs);
    const int rotations = dofs.size() - dofs.translations();
    const Eigen::MatrixXd turning = whole.bottomRightCorner(rotations, rotations);
    const auto values = symmetric_eigenvalues(turning);
    EXPECT_GT(values[0], 1e-6 * values[rotations - 1]);
  }
}

TEST(ShellStiffness, IsTheSumOfItsTriangles) {
  const ShellMesh mesh = bent_tube(5, 3);
  const ShellDofs dofs = all_free(mesh);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(dofs.size(), dofs.size());
  for (const auto& t : mesh.triangles) {
    const auto element = shell_element_stiffness({mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]]}, kWall,
                                                 Bending::discrete_kirchhoff);
    for (int i = 0; i < 18; ++i)
      for (int j = 0; j < 18; ++j) sum(dofs.index(t[i / 6], i % 6), dofs.index(t[j / 6], j % 6)) += element(i, j);
  }
  EXPECT_TRUE(Eigen::MatrixXd(whole_stiffness(mesh, dofs)).isApprox(sum, 1e-14));
}

TEST(ShellStiffness, LeavesOutFixedDofsAndUnusedNodes) {
  ShellMesh mesh = irregular_patch();
  const ShellDofs free_dofs = all_free(mesh);
  const Eigen::MatrixXd whole = whole_stiffness(mesh, free_dofs);
  mesh.nodes.insert(mesh.nodes.begin(), Eigen::Vector3d(9, 9, 9));
  for (auto& t : mesh.triangles)
    for (int& node : t) ++node;
  ShellDofs dofs = all_free(mesh);
  for (int node : {1, 2, 7})
    for (int dof : {0, 2, 5}) dofs.fix(node, dof);
  dofs.number();
  ASSERT_EQ(dofs.size(), free_dofs.size() - 9);
  EXPECT_EQ(dofs.index(0, 0), ShellDofs::kUnused);
  const auto lower = assemble_shell_stiffness(mesh, kWall, Bending::discrete_kirchhoff, dofs, "shell");
  const Eigen::MatrixXd remaining = SparseMatrix(lower.selfadjointView<Eigen::Lower>());
  const auto same = [&](int i) { return free_dofs.index(dofs.dof(i) / 6 - 1, dofs.dof(i) % 6); };
  for (int i = 0; i < dofs.size(); ++i)
    for (int j = 0; j <= i; ++j) ASSERT_EQ(remaining(i, j), whole(same(i), same(j)));
}

std::string refusal(const ShellMesh& mesh, Bending bending) {
  try {
    assemble_shell_stiffness(mesh, kWall, bending, all_free(mesh), "body 'duct'");
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(ShellStiffness, NamesTheTriangleThatCannotBe) {
  // Right isosceles triangles with the right angle first come second in each cell of this grid.
  const auto square = [](double u, double v) { return Eigen::Vector3d(u, v, 0); };
  ShellMesh grid = shell_grid(2, 2, square, Diagonals::alike);
  grid.triangles[4] = {grid.triangles[4][1], grid.triangles[4][2], grid.triangles[4][0]};
  EXPECT_EQ(refusal(grid, Bending::polynomial).rfind("body 'duct': triangle 4: the polynomial", 0), 0u);
  EXPECT_EQ(refusal(grid, Bending::discrete_kirchhoff), "");
  grid.nodes[grid.triangles[3][0]] = grid.nodes[grid.triangles[3][1]];
  EXPECT_NE(refusal(grid, Bending::discrete_kirchhoff).find("its corners lie on a line"), std::string::npos);
}

TEST(ShellMass, AddsUpToTheWallsAndSitsWhereTheTrianglesAre) {
  const ShellMesh mesh = irregular_patch();
  const auto mass = lumped_shell_mass(mesh, kWall);
  double sum = 0, moment = 0;
  for (std::size_t n = 0; n < mass.size(); ++n) {
    EXPECT_GT(mass[n], 0);
    sum += mass[n];
    moment += mass[n] * mesh.nodes[n].x();
  }
  EXPECT_NEAR(sum, 1.2 * 1 * kWall.thickness * kWall.density, 1e-12 * sum);
  EXPECT_NEAR(moment / sum, 0.6, 1e-12);
}

}  // namespace
}  // namespace palpate
