#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/obj_file.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"
#include "render_node/image.hpp"
#include "tests/organ/phantom_image.hpp"
#include "tests/organ/surfaces_for_tests.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/organ/mesh_pieces.hpp"
#include "tools/organ/surface_library.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

constexpr int kX = 60, kY = 44, kZ = 22;

/// Two balls that touch, of labels 7 and 9, with a stray voxel of 7 and a cavity in 9; voxels of 1 x 1 x 2 mm.
class OrganCommand : public ::testing::Test {
 protected:
  static std::string header(const std::string& size = "XDIM=60\nYDIM=44\nZDIM=22\n") {
    std::string text =
        "#INRIMAGE-4#{\n" + size + "VDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=decm\nVX=1\nVY=1\nVZ=2\n";
    text.resize(252, '\n');
    return text + "##}\n";
  }
  static std::string voxels() {
    std::string all;
    for (int k = 0; k < kZ; ++k)
      for (int j = 0; j < kY; ++j)
        for (int i = 0; i < kX; ++i) {
          const Eigen::Vector3d x(i, j, 2 * k);
          const bool first = (x - Eigen::Vector3d(20, 22, 22)).norm() < 15;
          const bool second = (x - Eigen::Vector3d(42, 22, 22)).norm() < 10;
          all += first ? 7 : second ? 9 : 0;
        }
    all[voxel(3, 3, 3)] = 7;
    all[voxel(42, 22, 11)] = 0;
    return all;
  }
  static std::size_t voxel(int i, int j, int k) { return (static_cast<std::size_t>(k) * kY + j) * kX + i; }
  static ProgramResult organ(const std::filesystem::path& image, const std::string& arguments) {
    return run_program(program("palpate") + " organ " + image.string() + " " + arguments);
  }
  /// Both balls as one mesh, for all cases: with pictures, and once more, told as JSON.
  struct Balls {
    Balls() {
      const auto image = write_file(folder / "balls.inr", header() + voxels());
      const std::string to = "--label 7=liver --label 9=fat --group attachment=below:x --edge 0.006 -o ";
      drawn = organ(image, to + mesh() + " --preview " + (folder / "pictures").string());
      told = organ(image, to + again() + " --json");
    }
    std::string mesh() const { return folder / "balls.msh"; }
    std::string again() const { return folder / "again.msh"; }
    const OwnFolder folder{"organ-balls"};
    ProgramResult drawn, told;
  };
  static const Balls& balls() {
    static const Balls made;
    return made;
  }
  const OwnFolder folder_{"organ-image"};
};

TEST_F(OrganCommand, TwoLabelsBecomeOneMeshOfTwoGroupsWithTheirVolumesAndTheSameAgain) {
  const ProgramResult& made = balls().drawn;
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.out.find("'liver': a stray piece of 1 voxels (0.002 ml) at (3, 3, 6) mm: left out"), std::string::npos)
      << made.out;
  EXPECT_NE(made.out.find("'fat': a cavity of 1 voxels"), std::string::npos) << made.out;
  const TetMesh mesh = load_tet_mesh(balls().mesh(), 1);
  EXPECT_GE(measures_of(mesh).min_angle, 12);
  const std::string all = voxels();
  for (const auto& [name, label] : {std::pair{"liver", 7}, {"fat", 9}}) {
    double volume = 0;
    for (const int t : mesh.groups.at(name).tetrahedra) volume += tet_volume(mesh, mesh.tetrahedra[t]);
    const double counted = 2e-9 * static_cast<double>(std::count(all.begin(), all.end(), label));
    EXPECT_NEAR(volume, counted, 0.01 * counted) << name;
  }
  // One closed surface without handles, and no voxel's diagonal away from the balls.
  const Surface surface = extract_surface(mesh);
  EXPECT_EQ(2 * static_cast<int>(surface.nodes.size()) - 4, static_cast<int>(surface.triangles.size()));
  for (const int n : surface.nodes) {
    const double off = std::min(std::abs((mesh.nodes[n] - Eigen::Vector3d(0.02, 0.022, 0.022)).norm() - 0.015),
                                std::abs((mesh.nodes[n] - Eigen::Vector3d(0.042, 0.022, 0.022)).norm() - 0.01));
    EXPECT_LT(off, 2.45e-3) << mesh.nodes[n].transpose();
  }
  EXPECT_EQ(text_of(balls().mesh()), text_of(balls().again()));
}

TEST_F(OrganCommand, ASurfaceToBeLookedAtHasAMaterialForEachLabel) {
  const auto image = write_file(folder_ / "image.inr", header() + voxels());
  const auto look = folder_ / "look.obj";
  const auto made =
      organ(image, "--label 7=liver --label 9=gall_bladder --nodes 400 --group a=below:z --triangles 3000 -o " +
                       (folder_ / "o.msh").string() + " --visual " + look.string());
  ASSERT_EQ(made.status, 0) << made.err;
  const VisualMesh mesh = load_obj(look, 1e-3, load_mtl(folder_ / "look.mtl"), false);
  EXPECT_NEAR(static_cast<double>(mesh.triangles()), 3000, 450);
  ASSERT_EQ(mesh.parts.size(), 2u);
  EXPECT_EQ(mesh.parts[0].material, "liver");
  EXPECT_FALSE(mesh.parts[0].colour);
  EXPECT_EQ(mesh.parts[1].material, "gall_bladder");
  EXPECT_TRUE(mesh.parts[1].colour);
}

TEST_F(OrganCommand, PicturesShowTheBorderTheTetrahedraAndBothSurfaces) {
  ASSERT_EQ(balls().drawn.status, 0) << balls().drawn.err;
  const auto coloured = [](const Image& picture, int from,
                           int to) {  // pixels between two columns, neither grey nor black
    int count = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = from; x < to; ++x) {
        const std::uint8_t* p = picture.pixel(x, y);
        count += std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}) > 20;
      }
    return count;
  };
  for (const char* name : {"slice_0011.png", "surface.png"}) {
    const Image picture = read_png(balls().folder / "pictures" / name);
    const int left = coloured(picture, 0, picture.width / 2),
              right = coloured(picture, picture.width / 2, picture.width);
    EXPECT_GT(left, 10000) << name;
    EXPECT_NEAR(right, left, 0.25 * left) << name;
  }
}

TEST_F(OrganCommand, LabelsThatDoNotTouchBecomeAMeshEach) {
  std::string apart = voxels();
  for (int k = 0; k < kZ; ++k)
    for (int j = 0; j < kY; ++j)
      for (int i = 30; i < 36; ++i) apart[voxel(i, j, k)] = 0;
  const auto image = write_file(folder_ / "apart.inr", header() + apart);
  const auto made = organ(image,
                          "--label 7=big --label 9=small --nodes 400 --fine 0.042,0.022,0.012,0.003:0.003 "
                          "--fine 1,0,0,0.01:0.005 --preview " +
                              (folder_ / "pictures").string() + " -o " + (folder_ / "a.msh").string());
  ASSERT_EQ(made.status, 0) << made.err;
  const std::size_t idle = made.out.find("warning: --fine 1,0,0,0.01:0.005 reaches no part of the body");
  EXPECT_NE(idle, std::string::npos) << made.out;
  EXPECT_EQ(made.out.find("warning: --fine"), made.out.rfind("warning: --fine")) << "it is fine in one of them";
  EXPECT_NE(made.out.find("2 bodies that share no border"), std::string::npos) << made.out;
  for (const auto& [name, label] : {std::pair{"a_big.msh", 7}, {"a_small.msh", 9}}) {
    const double counted = 2e-9 * static_cast<double>(std::count(apart.begin(), apart.end(), label));
    const TetMesh mesh = load_tet_mesh(folder_ / name, 1);
    EXPECT_NEAR(measures_of(mesh).volume, counted, 0.01 * counted) << name;
    EXPECT_EQ(topology_of(mesh), (Topology{1, 0})) << name;
  }
  for (const char* name : {"big", "small"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "pictures" / name / "surface.png")) << name;
}

TEST_F(OrganCommand, NoFileOfAnotherKindIsReplacedUnderAnyName) {
  std::string apart = voxels();
  for (int k = 0; k < kZ; ++k)
    for (int j = 0; j < kY; ++j)
      for (int i = 30; i < 36; ++i) apart[voxel(i, j, k)] = 0;
  const auto image = write_file(folder_ / "kept.inr", header() + apart);
  write_file(folder_ / "k_small.msh", "mine");
  const auto made = organ(image, "--label 7=big --label 9=small --nodes 400 -o " + (folder_ / "k.msh").string());
  EXPECT_EQ(made.status, 1);
  EXPECT_NE(made.err.find("k_small.msh is "), std::string::npos) << made.err;
  EXPECT_EQ(text_of(folder_ / "k_small.msh"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "k_big.msh"));
}

/// A hollow box of label 5 in the empty corner.
std::string with_a_hollow_box(std::string voxels) {
  for (int k = 2; k < 12; ++k)
    for (int j = 2; j < 14; ++j)
      for (int i = 2; i < 14; ++i) {
        const bool rim = k % 9 == 2 || j % 11 == 2 || i % 11 == 2;
        voxels[(static_cast<std::size_t>(k) * kY + j) * kX + i] = rim ? 5 : 0;
      }
  return voxels;
}

TEST_F(OrganCommand, WhereOneOfSeveralMeshesFailsItIsNamedAndNoneIsWritten) {
  const std::string bytes = header() + with_a_hollow_box(voxels());
  const auto made = organ(write_file(folder_ / "box.inr", bytes),
                          "--label 9=ball --label 5=box --edge 0.006 -o " + (folder_ / "a.msh").string());
  EXPECT_EQ(made.status, 1);
  EXPECT_NE(made.err.find("'box': edges of 6 mm are too long"), std::string::npos) << made.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a_ball.msh"));
}

TEST_F(OrganCommand, PlacesAreToldInTheImagesWorld) {
  // Turned half a turn about z.
  const std::string meta =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "TransformMatrix = -1 0 0 0 -1 0 0 0 1\nOffset = -500 -200 1000\nElementSpacing = 1 1 2\n"
      "DimSize = 60 44 22\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
  const auto image = write_file(folder_ / "world.mha", meta + with_a_hollow_box(voxels()));
  const std::string mesh = (folder_ / "a.msh").string();
  const auto ball = organ(image, "--label 9 --nodes 200 -o " + mesh);
  if (ball.err.find("without ITK") != std::string::npos) GTEST_SKIP() << ball.err;
  const auto expect_place = [](const std::string& said, const std::string& before) {
    const std::size_t at = said.find(before);
    ASSERT_NE(at, std::string::npos) << said;
    Eigen::Vector3d x;
    ASSERT_EQ(std::sscanf(said.c_str() + at + before.size(), "%lf, %lf, %lf)", &x[0], &x[1], &x[2]), 3) << said;
    EXPECT_TRUE(x.x() <= -500 && x.x() >= -560 && x.y() <= -200 && x.y() >= -244 && x.z() >= 1000 && x.z() <= 1044)
        << said;
  };
  const std::size_t largest = ball.out.find("largest ");
  ASSERT_NE(largest, std::string::npos) << ball.out << ball.err;
  expect_place(ball.out.substr(largest), " at (");
  expect_place(organ(image, "--label 5 --edge 0.012 -o " + mesh).err, "thick at (");
}

TEST_F(OrganCommand, AGapKeepsLabelsThatTouchApart) {
  const auto image = write_file(folder_ / "balls.inr", header() + voxels());
  const auto made =
      organ(image, "--label 7=big --label 9=small --gap 1.5 --nodes 600 -o " + (folder_ / "a.msh").string());
  ASSERT_EQ(made.status, 0) << made.err;
  const TetMesh big = load_tet_mesh(folder_ / "a_big.msh", 1), small = load_tet_mesh(folder_ / "a_small.msh", 1);
  const Surface surface = extract_surface(small);
  const SurfaceTree tree({small.nodes, surface.triangles});
  double nearest = 1;
  for (const int n : extract_surface(big).nodes) nearest = std::min(nearest, tree.distance(big.nodes[n]));
  EXPECT_GT(nearest, 1e-3) << "triangles miss the gap's sides by up to the deviation";
  EXPECT_LT(nearest, 2.2e-3);
}

// Edges and corners are rounded: the volume that they lose is won elsewhere.
TEST_F(OrganCommand, FlatSidesOfAGapStayWhereTheyAre) {
  std::string boxes(voxels().size(), '\0');
  for (int k = 4; k < 10; ++k)
    for (int j = 4; j < 16; ++j)
      for (int i = 4; i < 26; ++i) boxes[voxel(i, j, k)] = i < 15 ? 1 : 2;
  const auto image = write_file(folder_ / "boxes.inr", header() + boxes);
  const auto made =
      organ(image, "--label 1=a --label 2=b --gap 0.5 --edge 0.006 --json -o " + (folder_ / "g.msh").string());
  ASSERT_EQ(made.status, 0) << made.err;
  const auto json = nlohmann::json::parse(made.out);
  EXPECT_NEAR(json["least_distance"]["distance_m"], 5e-4, 1e-4);
  EXPECT_TRUE(json["warnings"].empty()) << made.out;
  for (const auto& body : json["meshes"]) {
    const double volume = body["labels"][0]["volume_m3"], wanted = body["labels"][0]["volume_of_voxels_m3"];
    EXPECT_NEAR(volume, wanted, 1e-3 * wanted);
  }
  for (const Eigen::Vector3d& x : load_tet_mesh(folder_ / "g_a.msh", 1).nodes) EXPECT_LE(x.x(), 0.01425 + 5e-5);
  for (const Eigen::Vector3d& x : load_tet_mesh(folder_ / "g_b.msh", 1).nodes) EXPECT_GE(x.x(), 0.01475 - 5e-5);
}

TEST_F(OrganCommand, AWallOfTwoVoxelsIsMeshedWithItsCavity) {
  std::string shell;
  for (int k = 0; k < kZ; ++k)
    for (int j = 0; j < kY; ++j)
      for (int i = 0; i < kX; ++i) {
        const double r = Eigen::Vector3d(i - 30, j - 22, 2 * (k - 11)).norm();
        shell += static_cast<char>(r < 18 && r >= 14 ? 7 : 0);
      }
  const auto image = write_file(folder_ / "shell.inr", header() + shell);
  const auto made = organ(image, "--label 7=wall --nodes 2000 --report " + (folder_ / "found.csv").string() + " -o " +
                                     (folder_ / "a.msh").string());
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_NE(text_of(folder_ / "found.csv").find("\"kept\","), std::string::npos) << text_of(folder_ / "found.csv");
  const TetMesh mesh = load_tet_mesh(folder_ / "a.msh", 1);
  const double counted = 2e-9 * static_cast<double>(std::count(shell.begin(), shell.end(), 7));
  EXPECT_NEAR(measures_of(mesh).volume, counted, 0.01 * counted);
  EXPECT_EQ(topology_of(mesh), (Topology{2, 0}));
}

TEST_F(OrganCommand, TwoBallsBecomeASceneThatPassesItsCheck) {
  ASSERT_EQ(balls().drawn.status, 0) << balls().drawn.err;
  const std::string scene = balls().folder / "balls.toml";
  const auto made = run_program(program("palpate") + " scene " + balls().mesh() + " --tissue liver -o " + scene);
  ASSERT_EQ(made.status, 0) << made.err;
  const auto checked = run_program(program("palpate") + " check " + scene);
  EXPECT_EQ(checked.status, 0) << checked.out << checked.err;
}

TEST_F(OrganCommand, FiguresArePrintedAsOneLineOfJson) {
  const ProgramResult& made = balls().told;
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(std::ranges::count(made.out, '\n'), 1) << made.out;
  const auto json = nlohmann::json::parse(made.out);
  EXPECT_EQ(json["voxels"], (std::array{kX, kY, kZ}));
  EXPECT_EQ(json["found"][0]["first_m"][2], 0.006);
  ASSERT_EQ(json["meshes"].size(), 1u);
  const auto& labels = json["meshes"][0]["labels"];
  ASSERT_EQ(labels.size(), 2u);
  EXPECT_EQ(labels[1]["name"], "fat");
  EXPECT_NEAR(labels[0]["volume_m3"], labels[0]["volume_of_voxels_m3"], 1e-7);
  EXPECT_EQ(labels[0]["topology"], labels[0]["topology_of_voxels"]);
  EXPECT_EQ(labels[0]["pieces"], labels[0]["pieces_of_voxels"]);
  EXPECT_EQ(json["meshes"][0]["nodes"], load_tet_mesh(balls().again(), 1).nodes.size());
}

TEST_F(OrganCommand, ASmallBodyIsAskedForTheSizeOfItsVoxels) {
  const auto image = folder_ / "small.inr";
  write_phantom(image, {20, 20, 20}, 0.2, [](int i, int j, int k) {
    return (Eigen::Vector3d(i, j, k) - Eigen::Vector3d::Constant(9.5)).norm() < 8;
  });
  const auto made = organ(image, "--label 1 --edge 0.001 -o " + (folder_ / "small.msh").string());
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.out.find(" m across: are the image's voxels of the right size?"), std::string::npos) << made.out;
  EXPECT_EQ(made.out.find("--unit"), std::string::npos) << made.out;
}

// A part that is small beside its neighbour, of voxels as NIfTI has them, with whose sizes the mesher leaves one.
TEST_F(OrganCommand, NoTetrahedronHangsOnItsPartByAnEdgeAlone) {
  const auto image = folder_ / "bile.inr";
  write_phantom(image, {26, 22, 18}, {1.2f, 0.9f, 1.5f}, [](int i, int j, int k) {
    const auto within = [&](double x, double y, double z, double r) {
      return (Eigen::Vector3d(i, j, k) - Eigen::Vector3d(x, y, z)).squaredNorm() < r * r;
    };
    if (within(9, 9, 8, 6.2) || within(16, 10, 9, 4.5) || within(9, 15, 9, 3.6)) return 1;
    return within(19.5, 12, 10, 3.2) ? 2 : 0;
  });
  const auto made =
      organ(image, "--label 1=liver --label 2=bile --edge 0.004 --json -o " + (folder_ / "bile.msh").string());
  ASSERT_EQ(made.status, 0) << made.err;
  const auto figures = nlohmann::json::parse(made.out);
  ASSERT_EQ(figures["meshes"][0]["labels"].size(), 2u);
  for (const auto& label : figures["meshes"][0]["labels"]) {
    EXPECT_EQ(label["pieces"], 1) << label;
    EXPECT_EQ(label["pieces_of_voxels"], 1) << label;
  }
}

TEST_F(OrganCommand, WhatIsFoundIsToldAndReportedBeforeARefusal) {
  const auto image = write_file(folder_ / "balls.inr", header() + voxels()), report = folder_ / "found.csv";
  const auto refused = organ(image, fmt::format("--label 7=big --label 9=small --gap 40 --report {} -o {}",
                                                report.string(), (folder_ / "a.msh").string()));
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("a gap of 40 mm leaves"), std::string::npos) << refused.err;
  EXPECT_NE(refused.out.find("found: 'big': a stray piece"), std::string::npos) << refused.out;
  EXPECT_NE(text_of(report).find("'big': a stray piece of 1 voxels (0.002 ml)"), std::string::npos);
}

TEST_F(OrganCommand, MistakesAndDamageAreToldInASentence) {
  const auto refused = [&](const std::string& bytes, const std::string& label, const std::string& said) {
    const auto image = write_file(folder_ / "bad.inr", bytes);
    const auto result = organ(image, "--label " + label + " -o " + (folder_ / "c.msh").string());
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find(said), std::string::npos) << result.err;
  };
  refused(header() + voxels(), "5", "no voxel has the label 5");
  std::string one = voxels();
  std::ranges::replace(one, '\7', '\0');
  one[voxel(20, 22, 11)] = 7;
  refused(header() + one, "7", "the label 7 has 1 voxels that hang together: a body needs 27 at least");
  refused(header() + voxels(), "7 --label 9 --gap 40", "a gap of 40 mm leaves");
  refused(header() + voxels(), "7 --edge 1e-7", "edges of 0.0001 mm would be about");
  refused(header() + voxels(), "liver", "--label liver: NUMBER or NUMBER=NAME");
  refused(header() + voxels(), "4294967296",
          "--label 4294967296: labels are whole numbers from -2147483648 to 4294967295");
  for (const char* option : {" -o ", " -o a.msh --visual ", " -o a.msh --report "}) {  // before the image is read
    const std::string ending = std::string(option).ends_with("--visual ") ? ".obj" : option[4] == 'a' ? ".csv" : ".msh";
    const auto nowhere = organ("none.inr", "--label 7" + std::string(option) + "nowhere/a" + ending);
    EXPECT_NE(nowhere.err.find("it cannot be written, since the folder "), std::string::npos) << option << nowhere.err;
  }
  refused(header() + voxels().substr(0, 5000), "7", "bad.inr: it ends before its last voxel");
  refused(header("XDIM=60000\nYDIM=60000\nZDIM=60000\n"), "7", "a billion in all");
  refused(header("XDIM=nan\nYDIM=4\nZDIM=4\n"), "7", "its XDIM is");
  refused("#INRIMAGE-4#{\n", "7", "within its header");
  refused(std::string(30000, 'a'), "7", "does not begin as an INR image");
}

}  // namespace
}  // namespace palpate
