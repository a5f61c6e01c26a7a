#include "common/mesh/surface.hpp"

#include <map>

#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"

namespace palpate {
namespace {

void expect_closed(const Surface& surface) {
  std::map<std::array<int, 2>, int> directed;
  for (const auto& t : surface.triangles) {
    for (int c = 0; c < 3; ++c) ++directed[{t[c], t[(c + 1) % 3]}];
  }
  for (const auto& [edge, uses] : directed) {
    EXPECT_EQ(uses, 1);
    EXPECT_EQ(directed.count({edge[1], edge[0]}), 1u) << "open at the edge " << edge[0] << "-" << edge[1];
  }
}

void expect_boundary_of(const TetMesh& mesh) {
  const Surface surface = extract_surface(mesh);
  expect_closed(surface);
  const double volume = volume_of(mesh);
  EXPECT_NEAR(enclosed_volume(mesh.nodes, surface.triangles), volume, 1e-12 * volume);
}

TEST(Surface, OfOneTetrahedronIsItsFourFacesOutward) {
  const TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {7, 7, 7}}, {{0, 1, 2, 3}}, {}};
  const Surface surface = extract_surface(mesh);
  EXPECT_EQ(surface.nodes, (std::vector<int>{0, 1, 2, 3}));
  ASSERT_EQ(surface.triangles.size(), 4u);
  EXPECT_EQ(surface.tetrahedra, (std::vector<int>{0, 0, 0, 0}));
  for (const auto& [a, b, c] : surface.triangles) {
    const Eigen::Vector3d normal = (mesh.nodes[b] - mesh.nodes[a]).cross(mesh.nodes[c] - mesh.nodes[a]);
    EXPECT_GT(normal.dot(mesh.nodes[a] - Eigen::Vector3d(0.1, 0.1, 0.1)), 0);
  }
}

TEST(Surface, OfABlockIsClosedOutwardAndHoldsOnlyBoundaryNodes) {
  const TetMesh mesh = make_block({0, 0, 0}, {2, 3, 4}, {4, 3, 5});
  expect_boundary_of(mesh);
  const Surface surface = extract_surface(mesh);
  EXPECT_EQ(surface.triangles.size(), 2u * 2 * (4 * 3 + 3 * 5 + 4 * 5));
  EXPECT_EQ(surface.nodes.size(), 5u * 4 * 6 - 3 * 2 * 4);
}

TEST(Surface, OfTheCylinderAndTheDefaultLiverIsClosedAndOutward) {
  expect_boundary_of(make_cylinder(0.015, 0.013, 5, 6));
  const TetMesh liver = load_tet_mesh(PALPATE_SOURCE "/scenes/meshes/liver.msh", 1);
  expect_boundary_of(liver);
}

TEST(Surface, NamesTheTetrahedronBehindEachTriangle) {
  const TetMesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  const Surface surface = extract_surface(mesh);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& tet = mesh.tetrahedra[surface.tetrahedra[i]];
    for (int n : surface.triangles[i]) EXPECT_NE(std::find(tet.begin(), tet.end(), n), tet.end());
  }
}

}  // namespace
}  // namespace palpate
