#include <gtest/gtest.h>

#include "common/fem/direct.hpp"
#include "common/mesh/surface.hpp"
#include "tests/fem/meshes_for_tests.hpp"

/// The patch test of MacNeal and Harder for solid elements: a unit cube of irregular elements whose boundary
/// moves by a linear field must carry one constant strain and stress.
namespace palpate {
namespace {

const Material kMaterial{1e6, 0.25, 1000};

Eigen::Vector3d exact(const Eigen::Vector3d& x) {
  return 1e-3 * Eigen::Vector3d(x.x() + 0.5 * x.y() + 0.5 * x.z(), 0.5 * x.x() + x.y() + 0.5 * x.z(),
                                0.5 * x.x() + 0.5 * x.y() + x.z());
}

TEST(Patch, ConstantStrainAndStressAreExactOnAnIrregularCube) {
  const auto mesh = testing::make_jittered_block({1, 1, 1}, {4, 4, 4}, 0.2);
  MaterialField materials;
  materials.materials.push_back(kMaterial);
  const StaticProblem problem{mesh, materials, DofMap(mesh)};
  std::vector<Constraint> boundary;
  for (int node : extract_surface(mesh).nodes)
    for (int axis = 0; axis < 3; ++axis) boundary.push_back(hold(node, axis, exact(mesh.nodes[node])[axis]));
  ASSERT_LT(boundary.size(), 3 * mesh.nodes.size());
  const auto solution = solve_direct(problem, boundary);

  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    EXPECT_LT((solution.displacement[i] - exact(mesh.nodes[i])).norm(), 1e-16);
  for (const auto& tet : mesh.tetrahedra) {
    Eigen::Matrix<double, 4, 3> u;
    for (int j = 0; j < 4; ++j) u.row(j) = solution.displacement[tet[j]];
    const auto gradients =
        tet_gradients({mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]], mesh.nodes[tet[3]]});
    const auto stress = element_stress(gradients, lame(kMaterial), u);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) EXPECT_NEAR(stress(i, j), i == j ? 2000 : 400, 1e-8);
  }
}

}  // namespace
}  // namespace palpate
