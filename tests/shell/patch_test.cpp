#include <gtest/gtest.h>

#include "common/fem/factorisation.hpp"
#include "tests/shell/irregular_shells.hpp"

namespace palpate {
namespace {

using namespace testing;

bool on_the_rim(const Eigen::Vector3d& x) {
  return x.x() < 1e-9 || x.x() > 1.2 - 1e-9 || x.y() < 1e-9 || x.y() > 1 - 1e-9;
}

/// Largest error of the inner nodes' motions over the largest motion, when those of the rim are held.
template <class MotionAt>
double patch_error(const ShellMesh& flat, Bending bending, MotionAt&& motion_at,
                   const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
  const ShellMesh mesh = turned(flat, turn);
  const ShellDofs everything = all_free(mesh);
  const SparseMatrix whole = whole_stiffness(mesh, everything, bending);
  const Eigen::VectorXd exact = motion_vector(mesh, everything, [&](const Eigen::Vector3d& x) {
    ShellMotion motion = motion_at(turn.transpose() * x);
    motion << (turn * motion.head<3>()).eval(), (turn * motion.tail<3>()).eval();
    return motion;
  });

  ShellDofs inner = all_free(mesh);
  Eigen::VectorXd held = Eigen::VectorXd::Zero(exact.size());
  for (int i = 0; i < everything.size(); ++i) {
    const int node = everything.dof(i) / 6;
    if (!on_the_rim(flat.nodes[node])) continue;
    inner.fix(node, everything.dof(i) % 6);
    held[i] = exact[i];
  }
  inner.number();
  const Eigen::VectorXd force = whole * held;
  Eigen::VectorXd load(inner.size()), expected(inner.size());
  for (int i = 0; i < inner.size(); ++i) {
    const int at = everything.index(inner.dof(i) / 6, inner.dof(i) % 6);
    load[i] = -force[at];
    expected[i] = exact[at];
  }
  const auto stiffness = assemble_shell_stiffness(mesh, kWall, bending, inner, "patch");
  Factorisation factor(stiffness);
  factor.factorise(stiffness);
  return (factor.solve(load) - expected).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
}

ShellMotion stretched(const Eigen::Vector3d& x) {
  const double exx = 1.5e-3, eyy = -0.7e-3, uy = 0.4e-3, vx = 1.1e-3;
  ShellMotion motion = ShellMotion::Zero();
  motion[0] = exx * x.x() + uy * x.y();
  motion[1] = vx * x.x() + eyy * x.y();
  motion[5] = (vx - uy) / 2;
  return motion;
}

ShellMotion bent(const Eigen::Vector3d& x) {
  const double xx = 1e-3, yy = -0.6e-3, xy = 0.8e-3;
  ShellMotion motion = ShellMotion::Zero();
  motion[2] = 0.5 * (xx * x.x() * x.x() + yy * x.y() * x.y()) + xy * x.x() * x.y();
  motion[3] = yy * x.y() + xy * x.x();
  motion[4] = -(xx * x.x() + xy * x.y());
  return motion;
}

TEST(PatchTest, MembraneCarriesConstantStrainOnIrregularTriangles) {
  for (unsigned seed : {1, 2, 3}) {
    EXPECT_LT(patch_error(irregular_patch(seed), Bending::discrete_kirchhoff, stretched), 1e-12);
    EXPECT_LT(patch_error(irregular_patch(seed), Bending::discrete_kirchhoff, stretched, some_turn()), 1e-11);
  }
}

TEST(PatchTest, DiscreteKirchhoffCarriesConstantCurvatureOnIrregularTriangles) {
  for (unsigned seed : {1, 2, 3}) {
    EXPECT_LT(patch_error(irregular_patch(seed), Bending::discrete_kirchhoff, bent), 1e-12);
    EXPECT_LT(patch_error(irregular_patch(seed), Bending::discrete_kirchhoff, bent, some_turn()), 1e-11);
  }
}

// Slopes across a common side differ between the paper's triangles: constant curvature does not pass from one
// to the next.
TEST(PatchTest, PolynomialMissesConstantCurvatureAsSoonAsTrianglesMeet) {
  const double error = patch_error(irregular_patch(), Bending::polynomial, bent);
  EXPECT_GT(error, 1e-3);
  EXPECT_LT(error, 1);
}

TEST(PatchTest, PolynomialStillBendsRigidlyTurnedPatchesWithoutForce) {
  const auto plane = [](const Eigen::Vector3d& x) -> ShellMotion {
    return (ShellMotion() << 0, 0, 0.01 + 0.02 * x.x() - 0.03 * x.y(), -0.03, -0.02, 0).finished();
  };
  EXPECT_LT(patch_error(irregular_patch(), Bending::polynomial, plane), 1e-10);
}

}  // namespace
}  // namespace palpate
