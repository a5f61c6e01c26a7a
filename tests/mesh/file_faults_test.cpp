#include "common/mesh/mesh_file.hpp"
#include "tests/mesh/literal_files.hpp"
#include "tests/mesh/mesh_test_helpers.hpp"

namespace palpate {
namespace {

/// What loading says about `bytes`, after the file's path.
std::string complaint(const std::string& name, const std::string& bytes) {
  const TestFolder folder;
  const auto file = folder.write(name, bytes);
  const std::string text = sentence_of([&] { load_tet_mesh(file, 1); });
  EXPECT_TRUE(text.starts_with(file.string() + ": ")) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  return text.substr(std::min(text.size(), file.string().size() + 2));
}

TEST(FileFault, AMissingFileIsNamed) {
  EXPECT_EQ(sentence_of([] { load_tet_mesh("/no/such.msh", 1); }), "/no/such.msh: the file does not exist");
  EXPECT_EQ(sentence_of([] { load_triangle_mesh("/no/such.stl", 1); }), "/no/such.stl: the file does not exist");
}

TEST(FileFault, AFolderIsNotAFile) {
  EXPECT_EQ(sentence_of([] { load_tet_mesh("/tmp", 1); }), "/tmp: this is not a file");
}

TEST(FileFault, TheScaleMustBePositive) {
  const TestFolder folder;
  const auto file = folder.write("a.msh", kGmsh1);
  for (double scale : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(sentence_of([&] { load_tet_mesh(file, scale); }).find("is not a positive number"), std::string::npos);
  }
}

TEST(FileFault, OtherTextIsNotTakenForAScript) {
  const TestFolder folder;
  const auto harmed = folder.path("harmed");
  EXPECT_EQ(complaint("a.msh", "SystemCall \"touch " + harmed.string() + "\";\n"),
            "it does not begin as a Gmsh mesh does, with $MeshFormat or $NOD");
  EXPECT_FALSE(std::filesystem::exists(harmed));
  EXPECT_EQ(complaint("a.geo", kGmsh1), "a mesh is read from .msh and .vtk files");
  EXPECT_EQ(complaint("a.msh", ""), "it does not begin as a Gmsh mesh does, with $MeshFormat or $NOD");
  EXPECT_EQ(complaint("a.vtk", kGmsh1), "it does not begin as a legacy VTK file does, with # vtk DataFile");
}

TEST(FileFault, AnIndexErrorNamesTheElementInEveryFormat) {
  const std::string expected = "element 1: node number 77 is not in the node list";
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh1, "3 8 5 2\n", "3 8 77 2\n")), expected);
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh2, "3 8 5 2\n", "3 8 77 2\n")), expected);
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh4, "3 8 5 2\n", "3 8 77 2\n")), expected);
  EXPECT_EQ(complaint("a.vtk", replaced(kVtk, "4 1 5 3 4\n", "4 1 77 3 4\n")), expected);
  EXPECT_EQ(complaint("a.vtk", replaced(kVtk, "4 1 5 3 4\n", "4 1 -1 3 4\n")),
            "element 1: node number -1 is not in the node list");
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh2, "3 10 3 5\n", "3 10 3 55\n")),
            "entry 2 of the element list: node number 55 is not in the node list");
}

TEST(FileFault, ACoordinateThatIsNoNumberIsNamed) {
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh2, "8 1 1 1", "8 1 nan 1")),
            "element 1: node 5 has a coordinate that is not a finite number");
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh1, "8 1 1 1", "8 1 inf 1")),
            "element 1: node 5 has a coordinate that is not a finite number");
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh1, "8 1 1 1", "8 1 x1 1")), "\"x1\" stands where a number should");
}

TEST(FileFault, InvertedDegenerateAndDuplicateElementsAreNamed) {
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh2, "3 8 5 2\n", "8 3 5 2\n")),
            "element 1: inverted, its volume is negative");
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh2, "3 8 5 2\n", "3 3 5 2\n")),
            "element 1: degenerate, it uses node 1 twice");
  EXPECT_EQ(complaint("a.vtk", replaced(kVtk, "4 1 5 3 4\n", "4 1 3 4 0\n")).substr(0, 47),
            "element 1: the same tetrahedron as element 0; e");
}

TEST(FileFault, ANodeNumberThatStandsTwiceIsNamed) {
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh1, "\n8 1 1 1", "\n3 1 1 1")),
            "node number 3 stands twice in the node list");
}

TEST(FileFault, OtherSolidsThanTetrahedraAreRefused) {
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh2, "4 4 2 6 1 3 8 5 2", "4 6 2 6 1 3 8 5 2 10 7")),
            "it has solid elements of 6 nodes; only tetrahedra of 4 nodes are computed with");
}

TEST(FileFault, AFileWithoutTetrahedraIsRefused) {
  const std::string only_triangle =
      replaced(replaced(replaced(kGmsh2, "9 4 2 5 1 10 3 5 2\n", ""), "4 4 2 6 1 3 8 5 2\n", ""), "$Elements\n3",
               "$Elements\n1");
  EXPECT_EQ(complaint("a.msh", only_triangle),
            "the mesh has no tetrahedra; where it is a surface, `palpate mesh SURFACE -o organ.msh` makes one of it");
  for (const char* surface : {"a.stl", "a.OBJ", "a.vtp"})
    EXPECT_EQ(complaint(surface, "solid"),
              "this is a surface, and a mesh of tetrahedra is asked for: `palpate mesh SURFACE -o organ.msh` makes one "
              "of it");
}

TEST(FileFault, VersionsThatAreNotReadSayWhatToDo) {
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh4, "4.1 0 8", "4 0 8")),
            "Gmsh format 4 is not read; save it as 4.1 or 2.2");
  EXPECT_EQ(complaint("a.vtk", replaced(kVtk, "Version 3.0", "Version 5.1")),
            "VTK files of version 5 are not read; save it as version 4.2 or as Gmsh 4.1");
  std::string other = gmsh2_binary();
  other.replace(other.find("8\n") + 2, 4, raw<int>({1}, true));
  EXPECT_EQ(complaint("a.msh", other), "it is binary with the byte order of another machine; save it as text");
}

TEST(FileFault, CountsBeyondTheFileAreRefusedBeforeAnyMemoryIsTaken) {
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh2, "$Nodes\n6", "$Nodes\n999999999999")),
            "the file announces 999999999999 nodes, which it is too short to hold");
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh1, "$NOD\n6", "$NOD\n-6")),
            "the file announces -6 nodes, which it is too short to hold");
}

TEST(FileFault, MissingSectionsAreNamed) {
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh2, "$Elements", "$Elephants")),
            "the file has no element list ($Elements)");
  EXPECT_EQ(complaint("a.msh", replaced(kGmsh1, "$ENDELM\n", "")), "the file ends too early");
  EXPECT_EQ(complaint("a.vtk", kVtk.substr(0, kVtk.find("CELL_TYPES"))),
            "the file has no list of cell types (CELL_TYPES)");
}

TEST(FileFault, AnStlThatIsCutShortIsRefused) {
  const TestFolder folder;
  write_stl({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, folder.path("a.stl"));
  const std::string bytes = bytes_of(folder.path("a.stl"));
  const auto cut = folder.write("b.stl", bytes.substr(0, bytes.size() - 1));
  EXPECT_EQ(sentence_of([&] { load_triangle_mesh(cut, 1); }),
            cut.string() + ": the file ends before its last triangle");
}

TEST(FileFault, AFileThatCannotBeWrittenIsNamed) {
  const TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {}};
  EXPECT_TRUE(
      sentence_of([&] { write_tet_mesh(mesh, "/no/such/folder/a.msh"); }).starts_with("/no/such/folder/a.msh: "));
  EXPECT_TRUE(sentence_of([&] { write_stl({}, "/no/such/folder/a.stl"); }).starts_with("/no/such/folder/a.stl: "));
  EXPECT_EQ(sentence_of([&] { write_tet_mesh(mesh, "a.obj"); }), "a.obj: a mesh is written to .msh and .vtk files");
}

}  // namespace
}  // namespace palpate
