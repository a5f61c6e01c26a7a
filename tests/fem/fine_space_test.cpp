#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "common/fem/fine_problem.hpp"
#include "common/fem/hat_tractions.hpp"
#include "common/fem/refine_mesh.hpp"
#include "common/geometry/dense_solvers.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"
#include "tests/fem/meshes_for_tests.hpp"

/// Refinement, shape functions and hat tractions of the offline discretisation.
namespace palpate {
namespace {

using Eigen::Vector3d;

const std::vector<Offline> kFiner{
    {1, FiniteElement::p1, Formulation::displacement}, {2, FiniteElement::p1, Formulation::displacement},
    {1, FiniteElement::p1, Formulation::locking_free}, {0, FiniteElement::p2, Formulation::displacement},
    {0, FiniteElement::p2, Formulation::locking_free}, {1, FiniteElement::p2, Formulation::locking_free}};

TEST(RefinedMesh, EightChildrenShareTheVolumeOfTheirTetrahedronAndAllArePositive) {
  const auto mesh = testing::make_organ({4, 3, 3});
  const auto fine = split_in_eight(mesh).mesh;
  ASSERT_EQ(fine.tetrahedra.size(), 8 * mesh.tetrahedra.size());
  for (std::size_t e = 0; e < fine.tetrahedra.size(); ++e)
    EXPECT_NEAR(tet_volume(fine, fine.tetrahedra[e]) / tet_volume(mesh, mesh.tetrahedra[e / 8]), 0.125, 1e-12);
}

TEST(RefinedMesh, IsConformingAndItsSurfaceIsTheOldOneInFour) {
  const auto mesh = testing::make_organ({4, 3, 3});
  const auto fine = split_in_eight(mesh).mesh;
  EXPECT_EQ(extract_surface(fine).triangles.size(), 4 * extract_surface(mesh).triangles.size());
  EXPECT_EQ(node_graph(mesh).neighbour.size(), fine.nodes.size()) << "one new node per edge";
}

TEST(FineSpace, InterpolationGivesTheNodesTheirPlaces) {
  const auto mesh = testing::make_organ({3, 3, 2});
  for (const auto& offline : kFiner) {
    const auto space = make_fine_space(mesh, offline);
    ASSERT_EQ(space.interpolation.size(), space.nodes.size());
    for (std::size_t i = 0; i < space.nodes.size(); ++i) {
      Vector3d place = Vector3d::Zero();
      const auto& hats = space.interpolation[i];
      for (int h = 0; h < hats.count; ++h) place += hats.weight[h] * mesh.nodes[hats.node[h]];
      EXPECT_LT((place - space.nodes[i]).norm(), 1e-15);
    }
  }
}

TEST(FineSpace, RefusesLinearElementsWithAPressureEach) {
  EXPECT_THROW(make_fine_space(testing::make_organ({3, 3, 2}), {0, FiniteElement::p1, Formulation::locking_free}),
               std::runtime_error);
}

TEST(FineStiffness, IsTheDerivativeOfTheInternalForceAndRigidMotionsMakeNone) {
  const auto mesh = testing::make_organ({3, 2, 2});
  auto body = testing::make_body(1, 0.45);
  for (const auto& offline : kFiner) {
    const auto problem = make_fine_problem(body, mesh, offline);
    const auto* pressures = problem.pressures ? &*problem.pressures : nullptr;
    std::vector<char> used(problem.space.nodes.size(), 1);
    const DofMap all(used);
    const auto stiffness =
        assemble_stiffness(problem.space, problem.materials, pressures, all, fine_graph(problem.space, pressures));
    std::vector<Vector3d> u, turn;
    for (std::size_t i = 0; i < problem.space.nodes.size(); ++i) {
      u.push_back({std::sin(3.0 * i), std::cos(5.0 * i), std::sin(2.0 * i + 1)});
      turn.push_back(Vector3d(1, -2, 3) + Vector3d(0.5, 2, -1).cross(problem.space.nodes[i]));
    }
    const auto vector = [&](const std::vector<Vector3d>& field) {
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(field[0].data(), all.size()));
    };
    const auto force = internal_force(problem.space, problem.materials, pressures, u);
    const Eigen::VectorXd product = stiffness.selfadjointView<Eigen::Lower>() * vector(u);
    EXPECT_LT((product - vector(force)).norm(), 1e-12 * product.norm());
    EXPECT_LT(vector(internal_force(problem.space, problem.materials, pressures, turn)).norm(), 1e-12 * product.norm());
  }
}

/// int phi_i x dS / int phi_i dS on the surface of the run-time mesh; elsewhere the node itself.
std::vector<Vector3d> hat_centroids(const TetMesh& mesh) {
  std::vector<Vector3d> centroid(mesh.nodes.size(), Vector3d::Zero());
  std::vector<double> area(mesh.nodes.size(), 0.0);
  for (const auto& t : extract_surface(mesh).triangles) {
    const double size = 0.5 * (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]]).norm();
    for (int a : t) {
      area[a] += size / 3;
      for (int b : t) centroid[a] += size / (a == b ? 6 : 12) * mesh.nodes[b];
    }
  }
  for (std::size_t i = 0; i < area.size(); ++i)
    centroid[i] = area[i] > 0 ? Vector3d(centroid[i] / area[i]) : mesh.nodes[i];
  return centroid;
}

TEST(HatTractions, HaveUnitResultantAndTheirMeansOfLinearFieldsAreTheNodesOrTheHatsCentroids) {
  const auto mesh = testing::make_organ({4, 3, 3});
  const auto centroid = hat_centroids(mesh);
  for (const auto& offline : kFiner)
    for (const auto weight : {SurfaceWeight::dual, SurfaceWeight::hat}) {
      const auto space = make_fine_space(mesh, offline);
      const auto hats = hat_tractions(space, mesh, weight);
      for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
        double sum = 0;
        Vector3d mean = Vector3d::Zero();
        for (SparseMatrix::InnerIterator it(hats, i); it; ++it) {
          sum += it.value();
          mean += it.value() * space.nodes[it.row()];
        }
        EXPECT_NEAR(sum, 1, 1e-13);
        EXPECT_LT((mean - (weight == SurfaceWeight::dual ? mesh.nodes[i] : centroid[i])).norm(), 1e-14);
      }
    }
}

TEST(HatTractions, DualOnesKeepTheNodalValuesOfEveryFieldOfTheRunTimeMesh) {
  const auto mesh = testing::make_organ({4, 3, 3});
  for (const auto& offline : kFiner) {
    const auto space = make_fine_space(mesh, offline);
    const auto hats = hat_tractions(space, mesh);
    for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
      std::vector<double> row(mesh.nodes.size(), 0.0);  // W^T P, P the interpolation: the identity
      for (SparseMatrix::InnerIterator it(hats, i); it; ++it) {
        const auto& from = space.interpolation[it.row()];
        for (int h = 0; h < from.count; ++h) row[from.node[h]] += it.value() * from.weight[h];
      }
      for (int j = 0; j < static_cast<int>(row.size()); ++j) EXPECT_NEAR(row[j], i == j, 1e-12);
    }
  }
}

TEST(HatTractions, OfLinearElementsOnTheRunTimeMeshItselfAreNodalForces) {
  const auto mesh = testing::make_organ({4, 3, 3});
  const auto hats = hat_tractions(make_fine_space(mesh, Offline{}), mesh);
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i)
    for (SparseMatrix::InnerIterator it(hats, i); it; ++it) EXPECT_NEAR(it.value(), it.row() == i, 1e-13);
}

TEST(FineProblem, HoldsExactlyThePlacesThatTheRunTimeMeshHolds) {
  const auto mesh = testing::make_organ({3, 3, 2});
  auto body = testing::make_body();
  body.fixed = {testing::fix_group("z0", {false, false, true}), testing::fix_group("x0", {true, true, false}),
                testing::fix_nodes({7})};
  for (const auto& offline : kFiner) {
    const auto problem = make_fine_problem(body, mesh, offline);
    for (int node = 0; node < problem.dofs.nodes(); ++node)
      for (int axis = 0; axis < 3; ++axis) {
        const auto& hats = problem.space.interpolation[node];
        double free = 0;  // weight of run-time nodes that may move
        for (int h = 0; h < hats.count; ++h)
          if (problem.run_time_dofs.is_free(hats.node[h], axis)) free += hats.weight[h];
        EXPECT_EQ(problem.dofs.is_free(node, axis), free > 0);
      }
  }
}

/// Strip the claim of stability down to a number: the least eigenvalue of B^T K(mu)^-1 B against the volumes does not
/// vanish with h on irregular meshes, so that no pressure goes unfelt (checkerboards) and none is forced (locking).
TEST(Pressures, AreAllFeltOnIrregularMeshes) {
  for (const Offline& offline : {Offline{0, FiniteElement::p2, Formulation::locking_free},
                                 Offline{1, FiniteElement::p1, Formulation::locking_free}}) {
    std::vector<double> least;
    for (int cells : {2, 4, 6}) {
      const auto mesh = testing::make_jittered_block({1, 1, 1}, {cells, cells, cells / 2}, 0.2);
      const auto problem = make_fine_problem(testing::make_body(1, 0.25), mesh, offline);
      const auto& pressures = *problem.pressures;
      auto none = pressures;
      none.modulus.setZero();
      const auto stiffness =
          assemble_stiffness(problem.space, problem.materials, &none, problem.dofs, fine_graph(problem.space, &none));
      Factorisation factor(stiffness);
      factor.factorise(stiffness);
      Eigen::MatrixXd divergence = Eigen::MatrixXd::Zero(problem.dofs.size(), pressures.modulus.size());
      for (Eigen::Index a = 0; a < divergence.cols(); ++a) {
        const double scale = std::sqrt(pressures.modulus[a] / lame({1, 0.25, 1}).lambda);  // 1/sqrt(volume)
        for (Eigen::SparseMatrix<double>::InnerIterator it(pressures.divergence, a); it; ++it)
          if (const int row = problem.dofs.index(static_cast<int>(it.row() / 3), static_cast<int>(it.row() % 3));
              row >= 0)
            divergence(row, a) = scale * it.value();
      }
      const Eigen::MatrixXd schur = divergence.transpose() * factor.solve(divergence);
      least.push_back(symmetric_eigenvalues(schur)[0] * lame({1, 0.25, 1}).mu);
    }
    std::printf("%s: %.4f %.4f %.4f\n", word_of(offline.element).data(), least[0], least[1], least[2]);
    EXPECT_GT(least[2], 0.01) << word_of(offline.element);
    EXPECT_GT(least[2], 0.7 * least[1]) << word_of(offline.element);
  }
}

}  // namespace
}  // namespace palpate
