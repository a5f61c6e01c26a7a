#include <gtest/gtest.h>

#include <numeric>

#include "tests/dynamics/hybrid_bodies.hpp"

/// What a cut of the tensor-mass part leaves to the quasi-static one.
namespace palpate {
namespace {

using Eigen::Vector3d;
using namespace testing;

const Vector3d kCutGravity(1.5, -0.7, -9.81);

std::vector<int> upper_part(const TetMesh& mesh, double height) {
  std::vector<int> part;
  for (int e = 0; e < static_cast<int>(mesh.tetrahedra.size()); ++e) {
    Vector3d at = Vector3d::Zero();
    for (int node : mesh.tetrahedra[e]) at += mesh.nodes[node] / 4;
    if (at.z() > height) part.push_back(e);
  }
  return part;
}

/// The static state of the mesh without some tetrahedra; nodes that lose their last one are left out.
template <class Scalar>
double difference_after(const std::vector<int>& removed) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  const auto body = hybrid_body(upper_part(mesh, 0.02), kCutGravity);
  HybridRun<Scalar> run(precompute(body, mesh), 0, 80, kCutGravity);
  run.run(0.05);
  run.model.remove(removed);
  run.run(1.6);

  auto problem = make_static_problem(body, mesh);
  const auto part = body.hybrid.regions[0].indices;
  std::vector<char> gone(mesh.tetrahedra.size(), 0);
  for (int t : removed) gone[part[t]] = 1;
  TetMesh left;
  left.nodes = mesh.nodes;
  left.groups = mesh.groups;
  MaterialField materials{problem.materials.materials, {}};
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e)
    if (!gone[e]) {
      left.tetrahedra.push_back(mesh.tetrahedra[e]);
      materials.of_element.push_back(problem.materials.of_element[e]);
    }
  problem.mesh = left;
  problem.materials = materials;
  problem.dofs = apply_boundary_conditions(left, body.fixed, "what is left");
  const auto direct = solve_loads(problem, weights(problem, kCutGravity));
  std::vector<Vector3d> ours, theirs;
  for (int i = 0; i < run.archive.surface.size(); ++i) {
    const int node = run.archive.surface.node_number[i];
    if (problem.dofs.index(node, 0) == DofMap::kUnused) continue;
    ours.push_back(run.displacement(i));
    theirs.push_back(direct.displacement[node]);
  }
  return relative_difference(ours, theirs);
}

TEST(HybridCut, RestsWhereTheRemainingMeshWould) {
  std::vector<int> some;
  for (int t = 0; t < 40; ++t) some.push_back(t);  // the layer at the border among them
  EXPECT_LT(difference_after<double>(some), 1e-6);
  EXPECT_LT(difference_after<float>(some), 1e-3);
}

/// Connection nodes move on with the mass of their quasi-static elements.
TEST(HybridCut, QuasiStaticPartAloneRelaxesWhenAllElseIsGone) {
  const auto mesh = make_hybrid_block({4, 3, 4}, 0.01);
  std::vector<int> all(upper_part(mesh, 0.02).size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_LT(difference_after<double>(all), 1e-6);
  EXPECT_LT(difference_after<float>(all), 1e-3);
}

}  // namespace
}  // namespace palpate
