#include "common/mesh/shell_file.hpp"

#include <random>

#include "common/mesh/mesh_file.hpp"
#include "common/mesh/shell_generators.hpp"
#include "common/mesh/shell_quality.hpp"
#include "tests/mesh/literal_files.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"

namespace palpate {
namespace {

// A flat strip of two triangles: node numbers 10, 3, 7, 5, 2 in this order, 7 in no element.
const std::string kShell2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 4 "rim"
2 7 "wall"
$EndPhysicalNames
$Nodes
5
10 0 0 0
3 1 0 0
7 9 9 9
5 0 1 0
2 1 1 0
$EndNodes
$Elements
4
1 1 2 4 1 10 3
2 15 2 9 1 2
5 2 2 7 3 10 3 5
8 2 2 7 3 3 2 5
$EndElements
)";

const std::string kShell4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
2 7 "wall"
$EndPhysicalNames
$Entities
0 0 1 0
3 0 0 0 1 1 0 1 7 0
$EndEntities
$Nodes
1 5 2 10
2 3 0 5
10
3
7
5
2
0 0 0
1 0 0
9 9 9
0 1 0
1 1 0
$EndNodes
$Elements
1 2 1 2
2 3 2 2
1 10 3 5
2 3 2 5
$EndElements
)";

const std::string kShellVtk = R"(# vtk DataFile Version 4.2
a strip
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 double
0 0 0
1 0 0
9 9 9
0 1 0
1 1 0
CELLS 2 8
3 0 1 3
3 1 4 3
CELL_TYPES 2
5
5
)";

void expect_strip(const ShellMesh& mesh, double scale) {
  ASSERT_EQ(mesh.nodes.size(), 5u);
  EXPECT_EQ(mesh.nodes[1], Eigen::Vector3d(scale, 0, 0));
  EXPECT_EQ(mesh.nodes[2], Eigen::Vector3d(9, 9, 9) * scale);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0], (std::array{0, 1, 3}));
  EXPECT_EQ(mesh.triangles[1], (std::array{1, 4, 3}));
}

TEST(ShellFile, NodeNumbersArePositionsInTheNodeListInEveryFormat) {
  const TestFolder folder;
  const ShellMesh two = load_shell_mesh(folder.write("a.msh", kShell2), 0.5);
  expect_strip(two, 0.5);
  EXPECT_EQ(two.groups.at("wall").nodes, (std::vector<int>{0, 1, 3, 4}));
  EXPECT_EQ(two.groups.at("rim").nodes, (std::vector<int>{0, 1}));
  EXPECT_EQ(two.groups.at("9").nodes, (std::vector<int>{4}));
  const ShellMesh four = load_shell_mesh(folder.write("b.msh", kShell4), 2);
  expect_strip(four, 2);
  EXPECT_EQ(four.groups.at("wall").nodes, (std::vector<int>{0, 1, 3, 4}));
  expect_strip(load_shell_mesh(folder.write("c.vtk", kShellVtk), 1), 1);
}

TEST(ShellFile, WhatIsWrittenIsReadBackTheSame) {
  const TestFolder folder;
  ShellMesh mesh = make_tube(0.005, 0.06, 20, 24);
  mesh.nodes.push_back({1, 2, 3});  // unused
  const auto file = folder.path("tube.msh");
  write_shell_mesh(mesh, file);
  const ShellMesh back = load_shell_mesh(file, 1);
  EXPECT_EQ(back.nodes, mesh.nodes);
  EXPECT_EQ(back.triangles, mesh.triangles);
  for (const char* end : {"end0", "end1"}) EXPECT_EQ(back.groups.at(end).nodes, mesh.groups.at(end).nodes);
  EXPECT_NE(sentence_of([&] { write_shell_mesh(mesh, "/no/such/folder.msh"); }), "");
}

TEST(ShellFile, CornersOfAnStlFileBecomeNodes) {
  const TestFolder folder;
  const ShellMesh tube = make_tube(0.005, 0.06, 12, 10);
  TriangleMesh turned{tube.nodes, tube.triangles};
  for (std::size_t t = 0; t < turned.triangles.size(); t += 3)
    std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  const auto file = folder.path("tube.stl");
  write_stl(turned, file);
  const ShellMesh mesh = load_shell_mesh(file, 2);
  EXPECT_EQ(mesh.nodes.size(), tube.nodes.size());
  EXPECT_EQ(mesh.triangles.size(), tube.triangles.size());
  EXPECT_TRUE(mesh.groups.empty());
  EXPECT_EQ(boundary_loops(mesh.triangles).size(), 2u);
  EXPECT_NEAR(enclosed_volume(mesh), 8 * enclosed_volume(tube), 1e-5 * enclosed_volume(tube));
}

TEST(ShellFile, WhatIsNoShellIsRefusedInWords) {
  const TestFolder folder;
  const auto complaint = [&](const char* name, const std::string& bytes) {
    const auto file = folder.write(name, bytes);
    const std::string text = sentence_of([&] { load_shell_mesh(file, 1); });
    EXPECT_TRUE(text.starts_with(file.string() + ": ")) << text;
    return text.substr(std::min(text.size(), file.string().size() + 2));
  };
  EXPECT_EQ(complaint("tets.msh", kGmsh2),
            "it has solid elements of 4 nodes; a shell is made of triangles of 3 nodes alone");
  std::string quad = kShell2;
  quad.replace(quad.find("8 2 2 7 3 3 2 5"), 15, "8 3 2 7 3 3 2 5 10");
  EXPECT_EQ(complaint("quad.msh", quad),
            "it has surface elements of 4 nodes; a shell is made of triangles of 3 nodes alone");
  std::string lines = kShell2.substr(0, kShell2.find("4\n1 1 2"));
  EXPECT_EQ(complaint("lines.msh", lines + "1\n1 1 2 4 1 10 3\n$EndElements\n"), "the mesh has no triangles");
  std::string lost = kShell2;
  lost.replace(lost.find("3 2 5\n$End"), 5, "3 77 5");
  EXPECT_EQ(complaint("lost.msh", lost), "entry 3 of the element list: node number 77 is not in the node list");
  EXPECT_EQ(complaint("shape.obj", "v 0 0 0\n"), "a surface is read from .msh, .vtk and .stl files");
  EXPECT_EQ(complaint("short.stl", std::string(84, '\x01')), "the file ends before its last triangle");
  EXPECT_EQ(sentence_of([] { load_shell_mesh("/no/such.msh", 1); }), "/no/such.msh: the file does not exist");
  const auto good = folder.write("good.msh", kShell2);
  EXPECT_NE(sentence_of([&] { load_shell_mesh(good, 0); }).find("is not a positive number"), std::string::npos);
}

// Damaged files end in a mesh or in one sentence that names the file.
TEST(ShellFile, WithFlippedBytesIsReadOrRefusedInWords) {
  const TestFolder folder;
  const auto tube = folder.path("tube.stl");
  const ShellMesh shape = make_tube(0.005, 0.06, 8, 4);
  write_stl({shape.nodes, shape.triangles}, tube);
  const std::pair<const char*, std::string> samples[] = {
      {"a.msh", kShell2}, {"b.msh", kShell4}, {"c.vtk", kShellVtk}, {"d.stl", bytes_of(tube)}};
  std::mt19937 random(3);
  int refused = 0;
  for (const auto& [name, sample] : samples)
    for (int round = 0; round < 50; ++round) {
      std::string bytes = sample;
      for (int flips = 1 + round % 3; flips > 0; --flips)
        bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
      if (round % 5 == 4) bytes.resize(random() % bytes.size());
      const auto file = folder.write(name, bytes);
      const std::string text = sentence_of([&] { check_shell_mesh(load_shell_mesh(file, 1), "after loading"); });
      EXPECT_TRUE(text.empty() || text.starts_with(file.string() + ": ")) << text;
      refused += !text.empty();
    }
  EXPECT_GT(refused, 60);
}

}  // namespace
}  // namespace palpate
