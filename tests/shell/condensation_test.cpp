#include "common/shell/condensation.hpp"

#include <gtest/gtest.h>

#include "common/fem/factorisation.hpp"
#include "common/geometry/dense_solvers.hpp"
#include "tests/shell/irregular_shells.hpp"

namespace palpate {
namespace {

using namespace testing;

/// Nodes that `held` names are clamped.
template <class Held>
ShellDofs clamped(const ShellMesh& mesh, Held&& held) {
  ShellDofs dofs = all_free(mesh);
  for (int n = 0; n < dofs.nodes(); ++n)
    for (int dof = 0; dof < 6; ++dof)
      if (held(mesh.nodes[n])) dofs.fix(n, dof);
  dofs.number();
  return dofs;
}

/// Largest difference of the translations that both ways give under random forces, over the largest
/// translation.
double disagreement(const SparseMatrix& lower, int translations) {
  Factorisation factor(lower);
  factor.factorise(lower);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(lower.rows());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> force(-1, 1);
  for (int i = 0; i < translations; ++i) load[i] = force(random);
  const Eigen::VectorXd full = factor.solve(load).col(0).head(translations);
  const Eigen::VectorXd condensed =
      DenseCholesky(condense_rotations(lower, translations)).solve(load.head(translations));
  return (condensed - full).cwiseAbs().maxCoeff() / full.cwiseAbs().maxCoeff();
}

TEST(CondensedRotations, AnswerForcesLikeTheFullSystem) {
  const ShellMesh tube = bent_tube();
  const ShellDofs held_tube = clamped(tube, [](const Eigen::Vector3d& x) { return std::abs(x.y()) < 1e-9; });
  const ShellMesh plate = irregular_patch();
  const ShellDofs held_plate = clamped(plate, [](const Eigen::Vector3d& x) { return x.x() < 1e-9; });
  for (auto bending : {Bending::discrete_kirchhoff, Bending::polynomial}) {
    EXPECT_LT(disagreement(assemble_shell_stiffness(tube, kWall, bending, held_tube, "tube"), held_tube.translations()),
              1e-10);
    EXPECT_LT(
        disagreement(assemble_shell_stiffness(plate, kWall, bending, held_plate, "plate"), held_plate.translations()),
        1e-10);
  }
}

TEST(CondensedRotations, LeaveAFullSymmetricMatrix) {
  const ShellMesh tube = bent_tube();
  const ShellDofs dofs = all_free(tube);
  const auto condensed = condense_rotations(
      assemble_shell_stiffness(tube, kWall, Bending::discrete_kirchhoff, dofs, "tube"), dofs.translations());
  ASSERT_EQ(condensed.rows(), dofs.translations());
  EXPECT_EQ(condensed, condensed.transpose());
  EXPECT_GT((condensed.array() != 0).count(), 0.9 * condensed.size());
}

TEST(CondensedRotations, ChangeNothingWhereAllRotationsAreFixed) {
  const ShellMesh plate = irregular_patch();
  ShellDofs dofs = all_free(plate);
  for (int n = 0; n < dofs.nodes(); ++n)
    for (int dof : {3, 4, 5}) dofs.fix(n, dof);
  dofs.number();
  const auto lower = assemble_shell_stiffness(plate, kWall, Bending::discrete_kirchhoff, dofs, "plate");
  const Eigen::MatrixXd full = SparseMatrix(lower.selfadjointView<Eigen::Lower>());
  EXPECT_EQ(condense_rotations(lower, dofs.translations()), full);
}

}  // namespace
}  // namespace palpate
