#pragma once
#include "common/dynamics/elastic_mesh.hpp"
#include "common/fem/direct.hpp"
#include "tests/fem/meshes_for_tests.hpp"

namespace palpate::testing {

/// A static problem and the same body as a dynamic model takes it.
struct DynamicBody {
  StaticProblem problem;
  ElasticMesh mesh;
};

inline DynamicBody make_dynamic(TetMesh tets, const Material& material, const std::vector<BoundaryCondition>& fixed) {
  SolidSpec body;
  body.name = "organ";
  body.material = material;
  body.fixed = fixed;
  DynamicBody made{make_static_problem(body, std::move(tets)), {}};
  const TetMesh& mesh = made.problem.mesh;
  made.mesh = {mesh.nodes, mesh.tetrahedra, {}, {material}, {}};
  for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
    std::array<bool, 3> held;
    for (int axis = 0; axis < 3; ++axis) held[axis] = !made.problem.dofs.is_free(n, axis);
    made.mesh.fixed.push_back(held);
  }
  return made;
}

/// A body of irregular tetrahedra that stands on its bottom.
inline DynamicBody dynamic_block(const std::array<int, 3>& cells, const Material& material = {2e3, 0.4, 1000}) {
  const Eigen::Vector3d extent(0.01 * cells[0], 0.01 * cells[1], 0.01 * cells[2]);
  return make_dynamic(make_jittered_block(extent, cells, 0.15), material, {fix_group("bottom")});
}

inline std::vector<Eigen::Vector3d> random_field(std::size_t nodes, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<Eigen::Vector3d> field(nodes);
  for (auto& u : field) u = {uniform(random), uniform(random), uniform(random)};
  return field;
}

}  // namespace palpate::testing
