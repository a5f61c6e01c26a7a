#include "common/mesh/generators.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include "common/mesh/quality.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"

namespace palpate {
namespace {

TEST(Block, HasTheCountsTheVolumeAndPassesTheChecks) {
  const TetMesh mesh = make_block({-1, 0, 2}, {1, 3, 6}, {20, 20, 22});
  EXPECT_EQ(mesh.nodes.size(), 10143u);
  EXPECT_EQ(mesh.tetrahedra.size(), 52800u);
  EXPECT_NEAR(volume_of(mesh), 24, 1e-10);
  EXPECT_NO_THROW(check_tet_mesh(mesh, "block"));
}

TEST(Block, OfUnitCellsHasSixEqualTetrahedraPerCell) {
  const TetMesh mesh = make_block({0, 0, 0}, {3, 2, 2}, {3, 2, 2});
  for (const auto& t : mesh.tetrahedra) EXPECT_NEAR(tet_volume(mesh, t), 1.0 / 6, 1e-14);
}

TEST(Block, NumbersNodesWithXFastestAndEndsExactly) {
  const TetMesh mesh = make_block({0.1, 0.2, 0.3}, {0.7, 0.9, 1.1}, {3, 4, 5});
  const int i = 2, j = 3, k = 4;
  const Eigen::Vector3d x = mesh.nodes[(k * 5 + j) * 4 + i];
  EXPECT_NEAR((x - Eigen::Vector3d(0.1 + 0.6 * 2 / 3, 0.2 + 0.7 * 3 / 4, 0.3 + 0.8 * 4 / 5)).norm(), 0, 1e-15);
  EXPECT_EQ(mesh.nodes.front(), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(mesh.nodes.back(), Eigen::Vector3d(0.7, 0.9, 1.1));
}

TEST(Block, GroupsHoldExactlyTheNodesOfTheFaces) {
  const TetMesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 3, 4});
  for (const auto& [name, axis, value] : {std::tuple{"x0", 0, 0.0},
                                          {"x1", 0, 1.0},
                                          {"y0", 1, 0.0},
                                          {"y1", 1, 1.0},
                                          {"z0", 2, 0.0},
                                          {"z1", 2, 1.0},
                                          {"bottom", 2, 0.0},
                                          {"top", 2, 1.0}}) {
    std::vector<int> expected;
    for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
      if (mesh.nodes[n][axis] == value) expected.push_back(n);
    }
    EXPECT_EQ(mesh.groups.at(name).nodes, expected) << name;
  }
}

TEST(BlockOfFive, HasTheCountsTheVolumeAndPassesTheChecks) {
  const TetMesh mesh = make_block_of_five({-1, 0, 2}, {1, 3, 6}, {21, 21, 21});
  EXPECT_EQ(mesh.nodes.size(), 10648u);
  EXPECT_EQ(mesh.tetrahedra.size(), 46305u);
  std::set<std::array<int, 2>> edges;
  for (const auto& t : mesh.tetrahedra)
    for (int a : t)
      for (int b : t)
        if (a < b) edges.insert({a, b});
  EXPECT_EQ(edges.size(), 59598u);
  EXPECT_NEAR(volume_of(mesh), 24, 1e-10);
  EXPECT_NO_THROW(check_tet_mesh(mesh, "block of five"));
}

TEST(BlockOfFive, HasOneThirdOfEachCellInTheMiddleAndASixthAtFourCorners) {
  const TetMesh mesh = make_block_of_five({0, 0, 0}, {3, 2, 2}, {3, 2, 2});
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    EXPECT_NEAR(tet_volume(mesh, mesh.tetrahedra[t]), t % 5 == 0 ? 1.0 / 3 : 1.0 / 6, 1e-14);
  const TetMesh six = make_block({0, 0, 0}, {3, 2, 2}, {3, 2, 2});
  EXPECT_EQ(mesh.nodes, six.nodes);
  for (const auto& [name, group] : six.groups) EXPECT_EQ(mesh.groups.at(name).nodes, group.nodes) << name;
}

// Node-number sets of all tetrahedra after a mirroring of the grid.
std::set<std::set<int>> mirrored(const TetMesh& mesh, const std::function<Eigen::Vector3d(Eigen::Vector3d)>& mirror) {
  std::vector<int> image;
  for (const auto& x : mesh.nodes) {
    const Eigen::Vector3d y = mirror(x);
    int nearest = 0;
    for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
      if ((mesh.nodes[n] - y).norm() < (mesh.nodes[nearest] - y).norm()) nearest = n;
    }
    image.push_back(nearest);
  }
  std::set<std::set<int>> tetrahedra;
  for (const auto& t : mesh.tetrahedra) tetrahedra.insert({image[t[0]], image[t[1]], image[t[2]], image[t[3]]});
  return tetrahedra;
}

TEST(Block, WithEvenCellsIsSymmetricAboutItsMidPlanes) {
  const TetMesh mesh = make_block({-1, -1, -1}, {1, 1, 1}, {4, 4, 4});
  const auto same = mirrored(mesh, [](Eigen::Vector3d x) { return x; });
  for (int axis = 0; axis < 3; ++axis) {
    const auto flipped = mirrored(mesh, [axis](Eigen::Vector3d x) {
      x[axis] = -x[axis];
      return x;
    });
    EXPECT_EQ(flipped, same) << "axis " << axis;
  }
}

TEST(GradedBlock, KeepsItsPlanesAndPassesTheChecks) {
  const auto xs = centred_axis(-0.05, 0.05, 8, 1.4), zs = graded_axis(-0.1, 0, 6, 0.7);
  ASSERT_EQ(xs.size(), 9u);
  EXPECT_NEAR(xs[4], 0, 1e-17);
  EXPECT_NEAR((xs[6] - xs[5]) / (xs[5] - xs[4]), 1.4, 1e-12);
  EXPECT_NEAR((zs[2] - zs[1]) / (zs[1] - zs[0]), 0.7, 1e-12);
  EXPECT_EQ(zs.back(), 0);
  const TetMesh mesh = make_graded_block(xs, xs, zs);
  EXPECT_NO_THROW(check_tet_mesh(mesh, "graded"));
  EXPECT_NEAR(volume_of(mesh), 1e-3, 1e-16);
}

TEST(GradedBlock, RefusesAxesThatDoNotAscend) {
  EXPECT_NE(sentence_of([] { make_graded_block({0, 1, 1}, {0, 1}, {0, 1}); }), "");
  EXPECT_NE(sentence_of([] { make_graded_block({0}, {0, 1}, {0, 1}); }), "");
  EXPECT_NE(sentence_of([] { make_block({0, 0, 0}, {1, 1, 1}, {1, 0, 1}); }), "");
  EXPECT_NE(sentence_of([] { make_cylinder(1, 1, 0, 1); }), "");
}

TEST(Cylinder, HasTheCountsThePolygonVolumeAndPassesTheChecks) {
  for (int rings : {1, 2, 3, 6}) {
    for (int layers : {1, 2, 5}) {
      const TetMesh mesh = make_cylinder(0.015, 0.013, rings, layers);
      EXPECT_EQ(mesh.tetrahedra.size(), 18u * rings * rings * layers);
      EXPECT_EQ(mesh.nodes.size(), (1u + 3 * rings * (rings + 1)) * (layers + 1));
      EXPECT_NO_THROW(check_tet_mesh(mesh, "cylinder"));
      const int corners = 6 * rings;
      const double area = 0.5 * corners * std::sin(2 * std::numbers::pi / corners) * 0.015 * 0.015;
      EXPECT_NEAR(volume_of(mesh), 0.013 * area, 1e-17);
    }
  }
}

TEST(Cylinder, GroupsHoldTheEndsAndTheSide) {
  const TetMesh mesh = make_cylinder(2, 3, 4, 5);
  std::vector<int> bottom, top, side;
  for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
    const Eigen::Vector3d& x = mesh.nodes[n];
    if (x.z() == 0) bottom.push_back(n);
    if (x.z() == 3) top.push_back(n);
    if (std::abs(x.head<2>().norm() - 2) < 1e-12) side.push_back(n);
  }
  EXPECT_EQ(mesh.groups.at("bottom").nodes, bottom);
  EXPECT_EQ(mesh.groups.at("top").nodes, top);
  EXPECT_EQ(mesh.groups.at("side").nodes, side);
  EXPECT_EQ(side.size(), 24u * 6);
}

TEST(Cylinder, WithEvenLayersIsSymmetricAboutMidHeight) {
  const TetMesh mesh = make_cylinder(1, 2, 3, 4);
  const auto flipped = mirrored(mesh, [](Eigen::Vector3d x) { return Eigen::Vector3d(x.x(), x.y(), 2 - x.z()); });
  EXPECT_EQ(flipped, mirrored(mesh, [](Eigen::Vector3d x) { return x; }));
}

}  // namespace
}  // namespace palpate
