#include "common/mesh/shell_quality.hpp"

#include <numbers>
#include <random>

#include "common/mesh/shell_generators.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

std::string complaint(const ShellMesh& mesh) {
  return sentence_of([&] { check_shell_mesh(mesh, "duct.msh"); });
}

/// A flat square of two triangles.
ShellMesh square() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}};
}

ShellMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}, {}};
}

TEST(ShellMesh, SoundSurfacesPass) {
  EXPECT_EQ(complaint(make_tube(0.005, 0.06, 20, 24)), "");
  EXPECT_EQ(complaint(square()), "");
  EXPECT_EQ(complaint(tetrahedron()), "");
}

TEST(ShellMesh, NodesThatNoTriangleUsesPass) {
  ShellMesh mesh = make_tube(0.005, 0.06, 20, 24);
  mesh.nodes.insert(mesh.nodes.end(), 3, {9, 9, 9});
  EXPECT_EQ(complaint(mesh), "");
}

TEST(ShellMesh, FaultsAreNamedWithTheirTriangle) {
  EXPECT_EQ(complaint({}), "duct.msh: the mesh has no triangles");
  ShellMesh mesh = square();
  mesh.triangles[1][2] = 4;
  EXPECT_EQ(complaint(mesh), "duct.msh: triangle 1: node 4 does not exist, the mesh has 4 nodes");
  mesh = square();
  mesh.nodes[3].y() = std::nan("");
  EXPECT_EQ(complaint(mesh), "duct.msh: node 3 has a coordinate that is not a finite number");
  mesh = square();
  mesh.triangles[1] = {0, 2, 2};
  EXPECT_EQ(complaint(mesh), "duct.msh: triangle 1: degenerate, it uses node 2 twice");
  mesh = square();
  mesh.nodes[3] = {0.5, 0.5 + 1e-5, 0};
  EXPECT_EQ(complaint(mesh),
            "duct.msh: triangle 1: degenerate, its three nodes lie on a line (shape 1.2e-05, at least 1e-04 "
            "is needed)");
  mesh = square();
  mesh.triangles.push_back({2, 0, 1});
  EXPECT_NE(complaint(mesh).find("triangle 2: the same triangle as triangle 0"), std::string::npos);
  mesh = square();
  mesh.triangles[1] = {0, 3, 2};
  EXPECT_EQ(complaint(mesh), "duct.msh: triangle 1: turned against triangle 0, with which it shares an edge");
  mesh = square();
  mesh.nodes.push_back({0.5, 0.5, 1});
  mesh.triangles.push_back({0, 2, 4});
  EXPECT_EQ(complaint(mesh), "duct.msh: triangle 2: 3 triangles share the edge between nodes 0 and 2, two at most can");
}

TEST(ShellMesh, PartsThatDoNotHangTogetherAreRefused) {
  ShellMesh mesh = square();
  mesh.nodes.insert(mesh.nodes.end(), {{3, 0, 0}, {4, 0, 0}, {3, 1, 0}});
  mesh.triangles.push_back({4, 5, 6});
  EXPECT_EQ(complaint(mesh),
            "duct.msh: triangle 2: disconnected, it and 0 further triangles share no edge with triangle 0's part");
  mesh = square();  // a further triangle that hangs on by a node alone
  mesh.nodes.insert(mesh.nodes.end(), {{2, 1, 0}, {2, 2, 0}});
  mesh.triangles.push_back({2, 4, 5});
  const std::string text = complaint(mesh);
  EXPECT_NE(text.find("triangle 2: disconnected"), std::string::npos) << text;
  EXPECT_NE(text.find("node 2: parts of the shell meet only in it"), std::string::npos) << text;
}

TEST(ShellMesh, TwoMouthsThatTouchInANodeAreRefused) {
  ShellMesh mesh = make_tube(0.005, 0.06, 6, 4);
  const int a = 0, b = 4 * 6;  // a node of each mouth becomes one
  for (auto& t : mesh.triangles)
    for (int& n : t)
      if (n == b) n = a;
  EXPECT_NE(complaint(mesh).find("node 0: parts of the shell meet only in it"), std::string::npos) << complaint(mesh);
}

TEST(ShellOrientation, RandomlyTurnedTrianglesOfATubeComeOutOutward) {
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    ShellMesh mesh = make_tube(0.005, 0.06, 12, 10);
    const auto outward = mesh.triangles;
    for (auto& t : mesh.triangles)
      if (random() % 2 != 0) std::swap(t[1], t[2]);
    orient_shell(mesh, "x");
    EXPECT_EQ(complaint(mesh), "");
    for (std::size_t t = 0; t < outward.size(); ++t) {
      const auto &a = outward[t], &b = mesh.triangles[t];
      EXPECT_TRUE(b == a || (b == std::array{a[1], a[2], a[0]}) || (b == std::array{a[2], a[0], a[1]}));
    }
  }
}

TEST(ShellOrientation, AClosedShellLooksOutwardAndAFlatOneStaysAsItIs) {
  ShellMesh closed = tetrahedron();
  for (auto& t : closed.triangles) std::swap(t[1], t[2]);
  orient_shell(closed, "x");
  EXPECT_NEAR(enclosed_volume(closed), 1.0 / 6, 1e-15);
  for (bool turn : {false, true}) {
    ShellMesh flat = square();
    if (turn)
      for (auto& t : flat.triangles) std::swap(t[1], t[2]);
    const auto before = flat.triangles;
    orient_shell(flat, "x");
    EXPECT_EQ(flat.triangles, before);
  }
}

TEST(ShellOrientation, AMoebiusStripIsRefused) {
  ShellMesh mesh;
  constexpr int kCells = 12;
  for (int i = 0; i < kCells; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCells;
    const Vector3d out(std::cos(angle), std::sin(angle), 0),
        across = std::cos(angle / 2) * out + std::sin(angle / 2) * Vector3d::UnitZ();
    for (double side : {-0.2, 0.2}) mesh.nodes.push_back(out + side * across);
  }
  for (int i = 0; i < kCells; ++i) {
    const bool last = i + 1 == kCells;
    const int a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({b, d, c});
  }
  EXPECT_EQ(sentence_of([&] { orient_shell(mesh, "strip.msh"); }),
            "strip.msh: the surface has one side only, its triangles cannot be turned alike");
}

TEST(BoundaryLoops, RunWithTheTrianglesEachOnce) {
  const auto loops = boundary_loops(make_tube(1, 3, 5, 4).triangles);
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0], (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(loops[1], (std::vector<int>{20, 24, 23, 22, 21}));
  EXPECT_TRUE(boundary_loops(tetrahedron().triangles).empty());
  ShellMesh holed = make_tube(1, 3, 5, 4);
  holed.triangles.erase(holed.triangles.begin() + 17);
  EXPECT_EQ(boundary_loops(holed.triangles).size(), 3u);
}

TEST(EnclosedVolume, OfATubeIsThatOfThePrism) {
  const int around = 16;
  const double section = 0.5 * around * std::sin(2 * std::numbers::pi / around);
  EXPECT_NEAR(enclosed_volume(make_tube(1, 3, around, 4)), 3 * section, 1e-12);
}

TEST(LumenRadius, OfAStraightTubeIsThatOfThePolygonsInscribedCircle) {
  for (int around : {8, 20, 40})
    EXPECT_NEAR(lumen_radius(make_tube(0.005, 0.06, around, 24)), 0.005 * std::cos(std::numbers::pi / around), 1e-9);
}

TEST(LumenRadius, FindsTheWaist) {
  const auto waisted = [](double s) { return 0.005 - 0.002 * std::exp(-std::pow((s - 0.4) / 0.1, 2)); };
  const auto bent = [](double s) {
    return Vector3d(0.06 * s, 0, 0.01 * (s - std::sin(2 * std::numbers::pi * s) / (2 * std::numbers::pi)));
  };
  const double found = lumen_radius(make_tube(bent, waisted, 24, 60));
  EXPECT_NEAR(found, 0.003 * std::cos(std::numbers::pi / 24), 0.03 * 0.003);
}

TEST(LumenRadius, OfAClosedShellIsRefused) {
  EXPECT_THROW(lumen_radius(tetrahedron()), std::runtime_error);
}

TEST(Tube, FollowsItsCurveWithRingsAcrossIt) {
  const auto bent = [](double s) {
    return Vector3d(0.06 * s, 0, 0.01 * (s - std::sin(2 * std::numbers::pi * s) / (2 * std::numbers::pi)));
  };
  const ShellMesh mesh = make_tube(
      bent, [](double) { return 0.005; }, 20, 24);
  EXPECT_EQ(mesh.nodes.size(), 500u);
  EXPECT_EQ(mesh.triangles.size(), 960u);
  EXPECT_EQ(mesh.groups.at("end0").nodes.size(), 20u);
  EXPECT_EQ(mesh.groups.at("end1").nodes.front(), 480);
  EXPECT_EQ(complaint(mesh), "");
  EXPECT_GT(enclosed_volume(mesh), 0);
  const Vector3d along = bent(0.5 + 1e-4) - bent(0.5 - 1e-4);
  for (int j = 0; j < 20; ++j) {
    const Vector3d arm = mesh.nodes[12 * 20 + j] - bent(0.5);
    EXPECT_NEAR(arm.norm(), 0.005, 1e-12);
    EXPECT_NEAR(arm.dot(along.normalized()), 0, 1e-9);
  }
  EXPECT_THROW(make_tube(0.005, 0.06, 2, 24), std::runtime_error);
  EXPECT_THROW(make_tube(0, 0.06, 20, 24), std::runtime_error);
}

}  // namespace
}  // namespace palpate
