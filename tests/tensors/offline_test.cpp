#include <gtest/gtest.h>

#include <cmath>

#include "common/archive/static_solve.hpp"
#include "common/fem/fine_problem.hpp"
#include "common/geometry/dense_solvers.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tests/fem/meshes_for_tests.hpp"
#include "tests/tensors/spread_holds.hpp"

/// Archives computed from a finer discretisation than the run-time mesh.
namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::spread_holds;

const std::vector<Offline> kFiner{{1, FiniteElement::p1, Formulation::displacement},
                                  {1, FiniteElement::p1, Formulation::locking_free},
                                  {0, FiniteElement::p2, Formulation::displacement},
                                  {0, FiniteElement::p2, Formulation::locking_free},
                                  {1, FiniteElement::p2, Formulation::locking_free}};

Eigen::MatrixXd touchable_matrix(const Archive& archive) {
  const auto t = static_cast<Eigen::Index>(archive.touchable_dofs.size());
  Eigen::MatrixXd full(t, t);
  for (Eigen::Index i = 0; i < t; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) full(i, j) = full(j, i) = archive.touchable_compliance[i * (i + 1) / 2 + j];
  return full;
}

/// The direct solution of the same offline mesh against superposition, displacements and the forces of the holds.
void expect_agreement(QuasiStaticSpec body, const TetMesh& mesh, const Offline& offline, double tolerance = 1e-9) {
  body.offline = offline;
  const auto archive = precompute(body, mesh);
  const auto problem = make_fine_problem(body, mesh, offline);
  for (int count : {1, 3, 12}) {
    const auto holds = spread_holds(archive, count);
    const auto direct = solve_direct(problem, holds);
    const auto tensors = solve_tensors(archive, holds);
    std::vector<Vector3d> displacement, force;
    for (int i = 0; i < archive.surface.size(); ++i) {
      displacement.push_back(direct.displacement[archive.surface.node_number[i]]);
      force.push_back(direct.force[archive.surface.node_number[i]]);
      for (int axis = 0; axis < 3; ++axis)
        if (archive.surface.fixed[i][axis]) force.back()[axis] = 0;
    }
    SCOPED_TRACE(::testing::Message() << offline.refine << " " << word_of(offline.element) << " "
                                      << word_of(offline.formulation) << ", " << count << " nodes, nu "
                                      << body.material.poisson);
    EXPECT_LT(testing::relative_difference(tensors.displacement, displacement), tolerance);
    EXPECT_LT(testing::relative_difference(tensors.force, force), tolerance);
    Vector3d sum = Vector3d::Zero();
    double size = 0;
    for (const auto& f : direct.force) {
      sum += f;
      size += f.norm();
    }
    EXPECT_LT(sum.norm(), 1e-9 * size) << "holds and reactions balance";
  }
}

TEST(Offline, DirectSolutionEqualsSuperposition) {
  for (const auto& offline : kFiner)
    expect_agreement(testing::make_body(10e3, 0.45), testing::make_organ({4, 3, 3}), offline);
  expect_agreement(testing::make_body(10e3, 0.4999), testing::make_organ({4, 3, 3}),
                   {0, FiniteElement::p2, Formulation::locking_free});
  expect_agreement(testing::make_body(10e3, 0.4999999), testing::make_organ({4, 3, 3}),
                   {0, FiniteElement::p2, Formulation::locking_free}, 1e-7);
}

TEST(Offline, DirectSolutionEqualsSuperpositionWithPartlyFixedNodes) {
  auto body = testing::make_body();
  body.fixed = {testing::fix_group("z0", {false, false, true}), testing::fix_group("x0", {true, false, false}),
                testing::fix_group("y1", {false, true, false})};
  for (const auto& offline : kFiner) expect_agreement(body, testing::make_organ({4, 3, 3}), offline);
}

TEST(Offline, DirectSolutionEqualsSuperpositionWithATouchableSubset) {
  auto body = testing::make_body();
  body.touchable = NodeSelector{};
  body.touchable->group = "top";
  for (const auto& offline : kFiner) expect_agreement(body, testing::make_organ({4, 4, 3}), offline);
}

TEST(Offline, MaterialRegionsAreInherited) {
  auto body = testing::make_body(10e3, 0.3);
  MaterialRegion stiff;
  stiff.where.box = Box{{-1, -1, 0.03}, {0, 1, 1}};
  stiff.material = {500e3, 0.4999, 1000};
  const auto mesh = testing::make_organ({4, 3, 3});
  for (const auto& offline : kFiner) {
    body.materials = {stiff};
    expect_agreement(body, mesh, offline);
    body.offline = offline;
    const auto with = touchable_matrix(precompute(body, mesh));
    body.materials.clear();
    const auto without = touchable_matrix(precompute(body, mesh));
    EXPECT_LT(with.trace(), 0.98 * without.trace()) << "a stiff region stiffens";
  }
}

TEST(Offline, ComplianceIsSymmetricPositiveDefinite) {
  for (double poisson : {0.3, 0.4999, 0.4999999})
    for (const auto& offline : kFiner) {
      auto body = testing::make_body(10e3, poisson);
      body.offline = offline;
      const auto mesh = testing::make_organ({3, 3, 3});
      // Both triangles come from right-hand sides of their own where a node is both touchable and not.
      const auto archive = precompute(body, mesh);
      const Eigen::VectorXd eigenvalues = symmetric_eigenvalues(touchable_matrix(archive));
      // Pressed all around, incompressible tissue does not give way: that eigenvalue is 1 - 2 nu times smaller.
      EXPECT_GT(eigenvalues[0], 1e-3 * (1 - 2 * poisson) * eigenvalues.tail(1)[0])
          << word_of(offline.element) << " " << poisson;
      EXPECT_TRUE(DenseCholesky(touchable_matrix(archive)).positive_definite());

      body.touchable = NodeSelector{};
      body.touchable->group = "top";
      const auto part = precompute(body, mesh);
      std::vector<int> top;  // C_ot of the subset must be the same numbers as C_tt of the whole
      std::vector<int> place(3 * mesh.nodes.size(), -1);
      for (std::size_t i = 0; i < archive.touchable_dofs.size(); ++i)
        place[3 * archive.surface.node_number[archive.touchable_dofs[i].node] + archive.touchable_dofs[i].axis] =
            static_cast<int>(i);
      const auto whole = touchable_matrix(archive);
      double worst = 0;
      for (std::size_t i = 0; i < part.other_dofs.size(); ++i)
        for (std::size_t j = 0; j < part.touchable_dofs.size(); ++j) {
          const int a = place[3 * part.surface.node_number[part.other_dofs[i].node] + part.other_dofs[i].axis];
          const int b = place[3 * part.surface.node_number[part.touchable_dofs[j].node] + part.touchable_dofs[j].axis];
          worst = std::max(worst, std::abs(whole(a, b) - part.other_compliance[i * part.touchable_dofs.size() + j]));
        }
      EXPECT_LT(worst, (poisson > 0.49999 ? 1e-8 : 1e-11) * whole.cwiseAbs().maxCoeff());
    }
}

TEST(Offline, ASectionWithAllDefaultsChangesNoBit) {
  auto body = testing::make_body();
  const auto mesh = testing::make_organ({4, 4, 3});
  const auto plain = precompute(body, mesh);
  body.offline = Offline{};
  const auto same = precompute(body, mesh);
  EXPECT_EQ(plain.touchable_compliance, same.touchable_compliance);
  body.offline->refine = 1;
  EXPECT_NE(plain.touchable_compliance, precompute(body, mesh).touchable_compliance);
}

TEST(Offline, RefinementOfTheOfflineMeshConverges) {
  auto body = testing::make_body(10e3, 0.3);
  const auto mesh = testing::make_organ({4, 4, 3});
  const auto compliance = [&](int refine, FiniteElement element) {
    body.offline = Offline{refine, element, Formulation::displacement};
    return touchable_matrix(precompute(body, mesh));
  };
  const auto once = compliance(1, FiniteElement::p1), twice = compliance(2, FiniteElement::p1),
             quadratic = compliance(1, FiniteElement::p2);
  EXPECT_LT((twice - quadratic).norm(), 0.5 * (once - quadratic).norm());
  EXPECT_LT((twice - quadratic).norm(), 0.2 * quadratic.norm()) << "single nodes: the smallest forces of all";
}

TEST(Offline, LinearElementsOnTheRunTimeMeshItselfGiveTheNodalCompliance) {
  const auto mesh = testing::make_organ({4, 4, 3});
  const auto body = testing::make_body();
  const auto plain = precompute(body, mesh);
  const auto& surface = plain.surface;
  const auto split = surface.node_number.begin() + surface.touchable;
  const auto fine = surface_compliance(make_fine_problem(body, mesh, Offline{}), {surface.node_number.begin(), split},
                                       {split, surface.node_number.end()});
  ASSERT_EQ(fine.touchable.size(), plain.touchable_compliance.size());
  double worst = 0, size = 0;
  for (std::size_t i = 0; i < fine.touchable.size(); ++i) {
    worst = std::max(worst, std::abs(fine.touchable[i] - plain.touchable_compliance[i]));
    size = std::max(size, std::abs(plain.touchable_compliance[i]));
  }
  EXPECT_LT(worst, 1e-11 * size);
}

}  // namespace
}  // namespace palpate
