#include <bit>
#include <cstdint>
#include <limits>

#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/mesh/literal_files.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"

namespace palpate {
namespace {

// Every literal file holds the same mesh: six nodes with scrambled numbers, the third in no element.
void expect_literal_mesh(const TetMesh& mesh, double scale) {
  const std::vector<Eigen::Vector3d> expected{{0, 0, 0}, {1, 0, 0}, {9, 9, 9}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  ASSERT_EQ(mesh.nodes.size(), 6u);
  for (int n = 0; n < 6; ++n) EXPECT_EQ(mesh.nodes[n], scale * expected[n]) << "node " << n;
  EXPECT_EQ(mesh.tetrahedra, (std::vector<std::array<int, 4>>{{0, 1, 3, 4}, {1, 5, 3, 4}}));
}

void expect_literal_groups(const TetMesh& mesh) {
  EXPECT_EQ(mesh.groups.at("5").tetrahedra, (std::vector<int>{0}));
  EXPECT_EQ(mesh.groups.at("5").nodes, (std::vector<int>{0, 1, 3, 4}));
  EXPECT_EQ(mesh.groups.at("6").tetrahedra, (std::vector<int>{1}));
  EXPECT_EQ(mesh.groups.at("6").nodes, (std::vector<int>{1, 3, 4, 5}));
  EXPECT_EQ(mesh.groups.at("7").nodes, (std::vector<int>{0, 1, 3}));
  EXPECT_TRUE(mesh.groups.at("7").tetrahedra.empty());
}

TEST(LiteralFile, Gmsh1KeepsTheOrderOfTheNodeListAndUnusedNodes) {
  const TestFolder folder;
  const TetMesh mesh = load_tet_mesh(folder.write("a.msh", kGmsh1), 1);
  expect_literal_mesh(mesh, 1);
  expect_literal_groups(mesh);
}

TEST(LiteralFile, Gmsh2KeepsOrderUnusedNodesAndGroupsOfElementsInOneEntity) {
  const TestFolder folder;
  const TetMesh mesh = load_tet_mesh(folder.write("a.msh", kGmsh2), 1);
  expect_literal_mesh(mesh, 1);
  expect_literal_groups(mesh);
  EXPECT_EQ(mesh.groups.at("left half").tetrahedra, (std::vector<int>{0}));
  EXPECT_EQ(mesh.groups.at("base").nodes, (std::vector<int>{0, 1, 3}));
}

TEST(LiteralFile, Gmsh2BinaryIsReadLikeTheText) {
  const TestFolder folder;
  const TetMesh mesh = load_tet_mesh(folder.write("a.msh", gmsh2_binary()), 1);
  expect_literal_mesh(mesh, 1);
  expect_literal_groups(mesh);
  EXPECT_EQ(mesh.groups.at("left half").tetrahedra, (std::vector<int>{0}));
}

TEST(LiteralFile, Gmsh4KeepsTheOrderOfItsBlocksAndUnusedNodes) {
  const TestFolder folder;
  const TetMesh mesh = load_tet_mesh(folder.write("a.msh", kGmsh4), 1);
  expect_literal_mesh(mesh, 1);
  expect_literal_groups(mesh);
  EXPECT_EQ(mesh.groups.at("left half").tetrahedra, (std::vector<int>{0}));
}

TEST(LiteralFile, Gmsh4BinaryIsReadLikeTheText) {
  const TestFolder folder;
  const TetMesh mesh = load_tet_mesh(folder.write("a.msh", gmsh4_binary()), 1);
  expect_literal_mesh(mesh, 1);
  expect_literal_groups(mesh);
}

TEST(LiteralFile, VtkTextAndBinaryKeepOrderAndUnusedNodes) {
  const TestFolder folder;
  expect_literal_mesh(load_tet_mesh(folder.write("a.vtk", kVtk), 1), 1);
  expect_literal_mesh(load_tet_mesh(folder.write("b.vtk", vtk_binary<double>("double")), 1), 1);
  expect_literal_mesh(load_tet_mesh(folder.write("c.vtk", vtk_binary<float>("float")), 1), 1);
}

TEST(LiteralFile, PointsOfATextThatAreCalledFloatKeepAllTheirDigits) {
  const TestFolder folder;
  const TetMesh mesh = load_tet_mesh(folder.write("a.vtk", R"(# vtk DataFile Version 3.0
one tetrahedron, as others write it
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 4 float
0 0 0 0.1 0 0
0 0.1 0
0 0 0.12345678
CELLS 1 5
4 0 1 2 3
CELL_TYPES 1
10
)"),
                                     1);
  ASSERT_EQ(mesh.nodes.size(), 4u);
  EXPECT_EQ(mesh.nodes[1].x(), 0.1);
  EXPECT_EQ(mesh.nodes[3].z(), 0.12345678);
}

TEST(LiteralFile, IsScaledToMetres) {
  const TestFolder folder;
  expect_literal_mesh(load_tet_mesh(folder.write("a.msh", kGmsh2), 0.001), 0.001);
}

TEST(LiteralFile, WithWindowsLineEndsIsReadTheSame) {
  const TestFolder folder;
  for (const auto& [name, text] : {std::pair{"a.msh", kGmsh1}, {"b.msh", kGmsh2}, {"c.msh", kGmsh4}}) {
    expect_literal_mesh(load_tet_mesh(folder.write(name, replaced(text, "\n", "\r\n")), 1), 1);
  }
}

TEST(LiteralFile, ThatIsNegativeThroughoutIsTurned) {
  const TestFolder folder;
  std::string text = replaced(replaced(kGmsh2, "10 3 5 2\n", "10 3 2 5\n"), "3 8 5 2\n", "3 8 2 5\n");
  EXPECT_NO_THROW(check_tet_mesh(load_tet_mesh(folder.write("a.msh", text), 1), "a"));
}

TEST(Groups, AnElementRepeatedForItsSecondGroupIsOneElement) {
  const TestFolder folder;
  const std::string text =
      replaced(replaced(kGmsh2, "$Elements\n3", "$Elements\n4"), "$EndElements", "12 4 2 6 1 10 3 5 2\n$EndElements");
  const TetMesh mesh = load_tet_mesh(folder.write("a.msh", text), 1);
  EXPECT_EQ(mesh.tetrahedra.size(), 2u);
  EXPECT_EQ(mesh.groups.at("5").tetrahedra, (std::vector<int>{0}));
  EXPECT_EQ(mesh.groups.at("6").tetrahedra, (std::vector<int>{0, 1}));
}

TEST(Groups, ANumberUsedInTwoDimensionsIsFoundByItsKind) {
  const TestFolder folder;
  const TetMesh mesh = load_tet_mesh(folder.write("a.msh", replaced(kGmsh2, "2 2 7 3", "2 2 5 3")), 1);
  EXPECT_EQ(mesh.groups.count("5"), 0u);
  EXPECT_EQ(mesh.groups.at("surface 5").nodes, (std::vector<int>{0, 1, 3}));
  EXPECT_EQ(mesh.groups.at("volume 5").tetrahedra, (std::vector<int>{0}));
}

// A block with two overlapping volume groups, a surface group, scattered nodes, and (where kept) an unused
// node.
TetMesh rich_mesh(bool with_unused_node) {
  TetMesh mesh = make_block({0, 0, 0}, {0.3, 0.2, 0.1}, {3, 2, 2});
  for (auto& x : mesh.nodes) x += 1e-3 * Eigen::Vector3d(std::sin(70 * x.y()), std::cos(90 * x.z()), x.x() / 3);
  const auto fill = [&](const char* name, int first, int last) {
    MeshGroup& group = mesh.groups[name];
    for (int t = first; t < last; ++t) {
      group.tetrahedra.push_back(t);
      group.nodes.insert(group.nodes.end(), mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
    }
    std::sort(group.nodes.begin(), group.nodes.end());
    group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()), group.nodes.end());
  };
  fill("all", 0, 72);
  fill("second half", 36, 72);
  mesh.groups["scattered"].nodes = {0, 7, 19};
  if (with_unused_node) {
    mesh.nodes.insert(mesh.nodes.begin() + 5, Eigen::Vector3d(7, 8, 9));
    for (auto& t : mesh.tetrahedra) {
      for (int& n : t) n += n >= 5;
    }
    for (auto& [name, group] : mesh.groups) {
      for (int& n : group.nodes) n += n >= 5;
    }
  }
  return mesh;
}

void expect_same_mesh(const TetMesh& read, const TetMesh& written) {
  ASSERT_EQ(read.nodes.size(), written.nodes.size());
  for (std::size_t n = 0; n < read.nodes.size(); ++n) EXPECT_LT((read.nodes[n] - written.nodes[n]).norm(), 1e-14);
  EXPECT_EQ(read.tetrahedra, written.tetrahedra);
}

TEST(RoundTrip, ThroughGmsh4KeepsEverything) {
  const TestFolder folder;
  const TetMesh mesh = rich_mesh(true);
  for (bool binary : {false, true}) {
    write_tet_mesh(mesh, folder.path("a.msh"), {4.1, binary});
    const TetMesh read = load_tet_mesh(folder.path("a.msh"), 1);
    expect_same_mesh(read, mesh);
    for (const auto& [name, group] : mesh.groups) {
      EXPECT_EQ(read.groups.at(name).nodes, group.nodes) << name;
      EXPECT_EQ(read.groups.at(name).tetrahedra, group.tetrahedra) << name;
    }
  }
}

TEST(RoundTrip, ThroughGmsh2KeepsMeshAndGroups) {
  const TestFolder folder;
  const TetMesh mesh = rich_mesh(false);
  for (bool binary : {false, true}) {
    write_tet_mesh(mesh, folder.path("a.msh"), {2.2, binary});
    const TetMesh read = load_tet_mesh(folder.path("a.msh"), 1);
    expect_same_mesh(read, mesh);
    for (const auto& [name, group] : mesh.groups) {
      EXPECT_EQ(read.groups.at(name).nodes, group.nodes) << name;
      EXPECT_EQ(read.groups.at(name).tetrahedra, group.tetrahedra) << name;
    }
  }
}

TEST(RoundTrip, ThroughGmsh1KeepsTheMeshAndNumbersOfGroups) {
  const TestFolder folder;
  const TetMesh mesh = rich_mesh(false);
  write_tet_mesh(mesh, folder.path("a.msh"), {1, false});
  const TetMesh read = load_tet_mesh(folder.path("a.msh"), 1);
  expect_same_mesh(read, mesh);
  int number = 0;
  for (const auto& [name, group] : mesh.groups) {
    EXPECT_EQ(read.groups.at(std::to_string(++number)).nodes, group.nodes) << name;
  }
}

TEST(RoundTrip, ThroughVtkKeepsTheMesh) {
  const TestFolder folder;
  const TetMesh mesh = rich_mesh(false);
  for (bool binary : {false, true}) {
    write_tet_mesh(mesh, folder.path("a.vtk"), {4.1, binary});
    expect_same_mesh(load_tet_mesh(folder.path("a.vtk"), 1), mesh);
  }
}

TEST(RoundTrip, OfTetrahedraWithoutGroupsThroughGmsh2KeepsThem) {
  const TestFolder folder;
  TetMesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  write_tet_mesh(mesh, folder.path("a.msh"), {2.2, false});
  const TetMesh read = load_tet_mesh(folder.path("a.msh"), 1);
  expect_same_mesh(read, mesh);
  EXPECT_EQ(read.groups.at("ungrouped").tetrahedra.size(), 48u);
  EXPECT_EQ(read.groups.at("x0").nodes, mesh.groups.at("x0").nodes);
}

TEST(TriangleFile, StlTextAndBinaryGiveTheSurface) {
  const TestFolder folder;
  const TetMesh block = make_block({0, 0, 0}, {1, 2, 3}, {2, 2, 2});
  write_stl({block.nodes, extract_surface(block).triangles}, folder.path("a.stl"));
  const TriangleMesh read = load_triangle_mesh(folder.path("a.stl"), 0.1);
  EXPECT_EQ(read.triangles.size(), 48u);
  EXPECT_EQ(read.nodes.size(), 26u);
  EXPECT_NEAR(enclosed_volume(read.nodes, read.triangles), 6e-3, 1e-9);

  const TriangleMesh text = load_triangle_mesh(folder.write("b.stl", kStl), 1);
  EXPECT_EQ(text.triangles.size(), 2u);
  EXPECT_EQ(text.nodes.size(), 4u);
}

TEST(TriangleFile, OfGmshGivesItsTrianglesOrElseTheBoundary) {
  const TestFolder folder;
  const TriangleMesh triangles = load_triangle_mesh(folder.write("a.msh", kGmsh2), 1);
  EXPECT_EQ(triangles.triangles.size(), 1u);
  EXPECT_EQ(triangles.nodes.size(), 3u);
  const TriangleMesh boundary = load_triangle_mesh(folder.write("b.vtk", kVtk), 1);
  EXPECT_EQ(boundary.triangles.size(), 6u);
  EXPECT_EQ(boundary.nodes.size(), 5u);
  EXPECT_NEAR(enclosed_volume(boundary.nodes, boundary.triangles), 0.5, 1e-12);
}

TEST(RealLiver, IsReadWithItsNodesInOrder) {
  const std::filesystem::path file = PALPATE_SOURCE "/../shared/data/liver.msh";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the real liver (" << file << ") is not on this machine";
  const TetMesh liver = load_tet_mesh(file, 0.01);
  EXPECT_EQ(liver.nodes.size(), 181u);
  EXPECT_EQ(liver.tetrahedra.size(), 596u);
  EXPECT_LT((liver.nodes[4] - 0.01 * Eigen::Vector3d(0.775631, 3.14952, 1.89897)).norm(), 1e-15);
  EXPECT_EQ(liver.groups.at("1").nodes.size(), 181u);
  const Surface surface = extract_surface(liver);
  EXPECT_NEAR(enclosed_volume(liver.nodes, surface.triangles), volume_of(liver), 1e-12 * volume_of(liver));
}

TEST(MeshFile, LoadingPrintsNothing) {
  const TestFolder folder;
  const auto good = folder.write("a.msh", kGmsh2), bad = folder.write("b.msh", replaced(kGmsh2, "$EndElements", ""));
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  load_tet_mesh(good, 1);
  sentence_of([&] { load_tet_mesh(bad, 1); });
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace palpate
