#include "common/mesh/quality.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "common/mesh/generators.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"

namespace palpate {
namespace {

std::string verdict(const TetMesh& mesh) {
  return sentence_of([&] { check_tet_mesh(mesh, "m.msh"); });
}

TetMesh good() {
  return make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
}

TEST(Quality, ShapeIsOneForARegularTetrahedronAtAnySize) {
  for (double size : {1e-6, 1.0, 1e6}) {
    TetMesh mesh{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2, 3}}, {}};
    for (auto& x : mesh.nodes) x *= size;
    EXPECT_NEAR(std::abs(tet_shape(mesh, mesh.tetrahedra[0])), 1, 1e-12);
    EXPECT_NEAR(tet_shape(mesh, {0, 2, 1, 3}), -tet_shape(mesh, {0, 1, 2, 3}), 1e-12);
    EXPECT_NEAR(min_dihedral_angle(mesh, mesh.tetrahedra[0]), std::acos(1.0 / 3), 1e-12);
  }
}

TEST(Quality, DihedralAngleOfARightCornerIsThatOfItsSlantedFace) {
  const TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {}};
  EXPECT_NEAR(min_dihedral_angle(mesh, mesh.tetrahedra[0]), std::atan(std::numbers::sqrt2), 1e-12);
}

TEST(Quality, AGoodMeshPasses) {
  EXPECT_EQ(verdict(good()), "");
}

TEST(Quality, NoTetrahedraAreAFault) {
  EXPECT_EQ(verdict({}), "m.msh: the mesh has no tetrahedra");
}

TEST(Quality, AnInvertedElementIsNamed) {
  TetMesh mesh = good();
  std::swap(mesh.tetrahedra[17][0], mesh.tetrahedra[17][1]);
  EXPECT_EQ(verdict(mesh), "m.msh: element 17: inverted, its volume is negative");
}

TEST(Quality, AFlatElementIsDegenerateHoweverSmall) {
  for (double size : {1e-3, 1.0}) {
    TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-7}}, {{0, 1, 2, 3}}, {}};
    for (auto& x : mesh.nodes) x *= size;
    EXPECT_TRUE(verdict(mesh).starts_with("m.msh: element 0: degenerate, its four nodes lie in a plane"))
        << verdict(mesh);
    mesh.nodes[3].z() = 1e-5 * size;
    EXPECT_EQ(verdict(mesh), "");
  }
}

TEST(Quality, ARepeatedNodeIsDegenerate) {
  TetMesh mesh = good();
  mesh.tetrahedra[3][2] = mesh.tetrahedra[3][1];
  EXPECT_TRUE(verdict(mesh).starts_with("m.msh: element 3: degenerate, it uses node ")) << verdict(mesh);
}

TEST(Quality, ADuplicateIsNamedWithItsFirst) {
  TetMesh mesh = good();
  const auto t = mesh.tetrahedra[5];
  mesh.tetrahedra.push_back({t[1], t[2], t[0], t[3]});
  EXPECT_EQ(verdict(mesh), "m.msh: element 48: the same tetrahedron as element 5");
}

TEST(Quality, NodeNumbersOutOfRangeAreNamed) {
  TetMesh mesh = good();
  mesh.tetrahedra[2][1] = 27;
  mesh.tetrahedra[4][0] = -1;
  EXPECT_EQ(verdict(mesh),
            "m.msh: element 2: node 27 does not exist, the mesh has 27 nodes; "
            "element 4: node -1 does not exist, the mesh has 27 nodes");
}

TEST(Quality, CoordinatesThatAreNotFiniteAreNamed) {
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TetMesh mesh = good();
    mesh.nodes[0].y() = bad;
    EXPECT_EQ(verdict(mesh), "m.msh: element 0: node 0 has a coordinate that is not a finite number");
    mesh = good();
    mesh.nodes.emplace_back(0, 0, bad);
    EXPECT_EQ(verdict(mesh), "m.msh: node 27 (in no element) has a coordinate that is not a finite number");
  }
}

TEST(Quality, ASecondPartIsDisconnected) {
  TetMesh mesh = good();
  const TetMesh other = make_block({5, 0, 0}, {6, 1, 1}, {1, 1, 1});
  for (auto t : other.tetrahedra) {
    for (int& n : t) n += 27;
    mesh.tetrahedra.push_back(t);
  }
  mesh.nodes.insert(mesh.nodes.end(), other.nodes.begin(), other.nodes.end());
  EXPECT_EQ(verdict(mesh),
            "m.msh: element 48: disconnected, it and 5 further elements share no node with element 0's part");
}

TEST(Quality, PartsThatMeetInANodeAreNotManifold) {
  const TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                     {{0, 1, 2, 3}, {0, 5, 4, 6}},
                     {}};
  EXPECT_EQ(verdict(mesh), "m.msh: element 1: not manifold, two parts of the surface meet only in node 0");
}

TEST(Quality, PartsThatMeetInAnEdgeAreNotManifold) {
  const TetMesh mesh{
      {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 2, 3, 1}, {0, 4, 5, 1}}, {}};
  EXPECT_TRUE(verdict(mesh).starts_with(
      "m.msh: element 0: not manifold, 4 surface triangles meet at the edge between nodes 0 and 1"))
      << verdict(mesh);
}

TEST(Quality, AFaceOfThreeElementsIsNotManifold) {
  const TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.2, 2}, {0, 0, -1}},
                     {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 2, 1, 5}},
                     {}};
  EXPECT_TRUE(verdict(mesh).starts_with(
      "m.msh: element 2: not manifold, its face with the nodes 0, 1 and 2 belongs to two other elements"))
      << verdict(mesh);
}

TEST(Quality, AllFaultsAreCountedAndTheFirstFiveListed) {
  TetMesh mesh = good();
  for (int e = 0; e < 12; ++e) std::swap(mesh.tetrahedra[e][0], mesh.tetrahedra[e][1]);
  const std::string text = verdict(mesh);
  EXPECT_NE(text.find("element 4: inverted"), std::string::npos);
  EXPECT_EQ(text.find("element 5: inverted"), std::string::npos);
  EXPECT_TRUE(text.ends_with("; and 7 more faults")) << text;
}

}  // namespace
}  // namespace palpate
