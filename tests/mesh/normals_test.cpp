#include "common/mesh/normals.hpp"

#include "common/mesh/generators.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"
#include "tools/generate/wrap.hpp"

namespace palpate {
namespace {

TEST(VertexNormals, OfASphereAreRadial) {
  const TriangleMesh sphere = geodesic_sphere(12);
  std::vector<Eigen::Vector3f> positions, normals(sphere.nodes.size(), Eigen::Vector3f::Constant(9));
  for (const auto& x : sphere.nodes) positions.push_back((0.1 * x).cast<float>());
  vertex_normals(positions, sphere.triangles, normals);
  for (std::size_t n = 0; n < normals.size(); ++n) {
    EXPECT_NEAR(normals[n].norm(), 1, 1e-6);
    EXPECT_GT(normals[n].dot(sphere.nodes[n].cast<float>()), 0.9995f);
  }
}

TEST(VertexNormals, WeighTrianglesByArea) {
  // A triangle of area 2 facing +z and one of area 1 facing +x share node 0 and 1.
  const std::vector<Eigen::Vector3f> positions{{0, 0, 0}, {0, 2, 0}, {-2, 0, 0}, {0, 0, 1}};
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {0, 1, 3}};
  std::vector<Eigen::Vector3f> normals(4);
  vertex_normals(positions, triangles, normals);
  const Eigen::Vector3f expected = Eigen::Vector3f(1, 0, 2).normalized();
  EXPECT_LT((normals[0] - expected).norm(), 1e-6f);
  EXPECT_LT((normals[2] - Eigen::Vector3f(0, 0, 1)).norm(), 1e-6f);
  EXPECT_LT((normals[3] - Eigen::Vector3f(1, 0, 0)).norm(), 1e-6f);
}

TEST(VertexNormals, AreZeroWithoutArea) {
  const std::vector<Eigen::Vector3f> positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}};
  std::vector<Eigen::Vector3f> normals(4, Eigen::Vector3f::Constant(3));
  vertex_normals(positions, triangles, normals);
  for (const auto& normal : normals) EXPECT_EQ(normal.norm(), 0);
}

TEST(VertexNormals, HoldForTrianglesOfAMicrometre) {
  const std::vector<Eigen::Vector3f> positions{{0, 0, 0}, {1e-6f, 0, 0}, {0, 1e-6f, 0}};
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}};
  std::vector<Eigen::Vector3f> normals(3);
  vertex_normals(positions, triangles, normals);
  for (const auto& normal : normals) EXPECT_LT((normal - Eigen::Vector3f::UnitZ()).norm(), 1e-6f);
}

}  // namespace
}  // namespace palpate
