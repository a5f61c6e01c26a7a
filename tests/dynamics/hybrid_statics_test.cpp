#include <gtest/gtest.h>

#include "common/geometry/dense_solvers.hpp"
#include "tests/dynamics/hybrid_bodies.hpp"

/// What the archive of a hybrid body holds, against dense algebra on the whole mesh.
namespace palpate {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using namespace testing;

const Vector3d kLoad(1.5, -0.7, -9.81);

/// The coupled system over the free dofs of the dynamic nodes, built from dense pieces.
struct Coupled {
  std::vector<Dof> dofs;
  MatrixXd stiffness;
  VectorXd load, mass;

  int place(int node, int axis) const {
    const auto found = std::find(dofs.begin(), dofs.end(), Dof{node, axis});
    return found == dofs.end() ? -1 : static_cast<int>(found - dofs.begin());
  }
};

Coupled couple(const Archive& archive, const Vector3d& gravity) {
  Coupled system;
  const auto mesh = elastic_mesh(archive);
  std::vector<char> used(mesh.nodes(), 0);
  for (const auto& t : mesh.tetrahedra)
    for (int node : t) used[node] = 1;
  for (int node = 0; node < mesh.nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (used[node] && !mesh.fixed[node][axis]) system.dofs.push_back({node, axis});
  const auto size = static_cast<Eigen::Index>(system.dofs.size());
  system.stiffness = MatrixXd::Zero(size, size);
  system.load = system.mass = VectorXd::Zero(size);
  std::vector<int> place(3 * mesh.nodes(), -1);
  for (int i = 0; i < size; ++i) place[3 * system.dofs[i].node + system.dofs[i].axis] = i;
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    const auto& t = mesh.tetrahedra[e];
    const auto gradients = tet_gradients({mesh.rest[t[0]], mesh.rest[t[1]], mesh.rest[t[2]], mesh.rest[t[3]]});
    const auto& material = mesh.material(static_cast<int>(e));
    const auto element = element_stiffness(gradients, lame(material));
    for (int i = 0; i < 12; ++i) {
      const int r = place[3 * t[i / 3] + i % 3];
      if (r < 0) continue;
      system.mass[r] += material.density * gradients.volume / 4;
      system.load[r] += material.density * gradients.volume / 4 * gravity[i % 3];
      for (int j = 0; j < 12; ++j)
        if (const int c = place[3 * t[j / 3] + j % 3]; c >= 0) system.stiffness(r, c) += element(i, j);
    }
  }
  const CondensedTensors& hybrid = *archive.condensed;
  for (std::size_t i = 0; i < hybrid.dofs.size(); ++i) {
    const int r = place[3 * hybrid.dofs[i].node + hybrid.dofs[i].axis];
    const auto k =
        std::find(hybrid.connection.begin(), hybrid.connection.end(), hybrid.dofs[i].node) - hybrid.connection.begin();
    system.mass[r] += hybrid.mass[k];
    system.load[r] += hybrid.reaction[i];
    for (std::size_t j = 0; j < hybrid.dofs.size(); ++j) {
      const int c = place[3 * hybrid.dofs[j].node + hybrid.dofs[j].axis];
      system.stiffness(r, c) += hybrid.stiffness[i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i];
    }
  }
  return system;
}

TEST(CondensedTensors, StaticStateIsThatOfTheWholeMeshWhereverTheBorderIs) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto body = hybrid_body(random_part(mesh, seed), kLoad);
    const auto archive = precompute(body, mesh);
    const auto problem = make_static_problem(body, mesh);
    const auto direct = solve_loads(problem, weights(problem, kLoad));
    const auto system = couple(archive, kLoad);
    const VectorXd u = DenseCholesky(system.stiffness).solve(system.load);
    const double size = u.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < u.size(); ++i)
      ASSERT_NEAR(u[i], direct.displacement[archive.surface.node_number[system.dofs[i].node]][system.dofs[i].axis],
                  1e-9 * size)
          << "border " << seed;
    const CondensedTensors& hybrid = *archive.condensed;
    auto rows = archive.touchable_dofs;
    rows.insert(rows.end(), archive.other_dofs.begin(), archive.other_dofs.end());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      double value = hybrid.sag[r];
      for (std::size_t c = 0; c < hybrid.dofs.size(); ++c)
        value += hybrid.follow[r * hybrid.dofs.size() + c] * u[system.place(hybrid.dofs[c].node, hybrid.dofs[c].axis)];
      ASSERT_NEAR(value, direct.displacement[archive.surface.node_number[rows[r].node]][rows[r].axis], 1e-9 * size)
          << "border " << seed;
    }
  }
}

/// The reaction alone: with the connection nodes held at zero, they feel the weight of the quasi-static part.
TEST(CondensedTensors, WeightOnConnectionNodesAndFixedNodesSumsToThatOfThePart) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  std::vector<int> upper;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    Vector3d centre = Vector3d::Zero();
    for (int node : mesh.tetrahedra[e]) centre += mesh.nodes[node] / 4;
    if (centre.z() < 0.02) upper.push_back(e);  // the lower half moves, the upper hangs on it without a fixed node
  }
  const auto archive = precompute(hybrid_body(upper, kLoad), mesh);
  const auto problem = make_static_problem(hybrid_body(upper, kLoad), mesh);
  Vector3d whole = Vector3d::Zero(), moving = Vector3d::Zero(), reaction = Vector3d::Zero();
  for (const auto& weight : weights(problem, kLoad)) whole += weight;
  const auto part = elastic_mesh(archive);
  for (std::size_t e = 0; e < part.tetrahedra.size(); ++e) {
    const auto& t = part.tetrahedra[e];
    moving += part.material(static_cast<int>(e)).density *
              tet_gradients({part.rest[t[0]], part.rest[t[1]], part.rest[t[2]], part.rest[t[3]]}).volume * kLoad;
  }
  for (std::size_t i = 0; i < archive.condensed->dofs.size(); ++i)
    reaction[archive.condensed->dofs[i].axis] += archive.condensed->reaction[i];
  EXPECT_LT((reaction - (whole - moving)).norm(), 1e-9 * whole.norm());
  EXPECT_TRUE(archive.condensed->held_by_connection);
}

TEST(CondensedTensors, FrequencyBoundIsRigorousWhereverTheBorderIs) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  double tightest = 0, loosest = 1;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto archive = precompute(hybrid_body(random_part(mesh, seed)), mesh);
    const auto system = couple(archive, Vector3d::Zero());
    const VectorXd scale = system.mass.cwiseSqrt().cwiseInverse();
    const MatrixXd scaled = scale.asDiagonal() * system.stiffness * scale.asDiagonal();
    const double largest = symmetric_eigenvalues(scaled).maxCoeff();
    const HybridRun<double> run(archive, 0, 0, Vector3d::Zero());
    const double bound = run.model.frequency_bound() * run.model.frequency_bound();
    ASSERT_LE(largest, bound) << "border " << seed;
    tightest = std::max(tightest, largest / bound);
    loosest = std::min(loosest, largest / bound);
  }
  std::printf("largest squared frequency over its bound: %.3f to %.3f\n", loosest, tightest);
  EXPECT_GT(loosest, 0.1);
}

TEST(CondensedTensors, CouplingIsSymmetricAndTakesNoEnergyOut) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  const auto archive = precompute(hybrid_body(random_part(mesh, 5)), mesh);
  CondensedPart part(archive, 0, false);
  const auto size = static_cast<Eigen::Index>(3 * part.connection().size());
  MatrixXd matrix = MatrixXd::Zero(size, size);
  for (Eigen::Index c = 0; c < size; ++c) {
    const VectorXd unit = VectorXd::Unit(size, c);
    VectorXd force = VectorXd::Zero(size);
    part.apply(unit.data(), force.data());
    matrix.col(c) = -force;
  }
  EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm());
  const VectorXd values = symmetric_eigenvalues(matrix);
  EXPECT_GT(values.minCoeff(), -1e-10 * values.maxCoeff());
}

}  // namespace
}  // namespace palpate
