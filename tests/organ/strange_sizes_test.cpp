#include <gtest/gtest.h>

#include <random>

#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/organ/surfaces_for_tests.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

/// Bodies that are no organ's: absurd, tiny, huge, far away, flat, with sharp edges.
class StrangeSizes : public ::testing::Test {
 protected:
  /// Returns the file; `corners` [m], triangles of a tetrahedron.
  std::string tetrahedron(const std::array<Eigen::Vector3d, 4>& corners) const {
    std::string text;
    for (const Eigen::Vector3d& x : corners) text += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
    return write_file(folder_ / "a.obj", text + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  }
  std::string box(double edge, double offset) const {
    return box(Eigen::Vector3d::Constant(edge), Eigen::Vector3d::Constant(offset));
  }
  std::string box(const Eigen::Vector3d& edge, const Eigen::Vector3d& offset) const {
    std::string text;
    for (int n = 0; n < 8; ++n)
      text += fmt::format("v {} {} {}\n", offset.x() + edge.x() * (n & 1), offset.y() + edge.y() * (n >> 1 & 1),
                          offset.z() + edge.z() * (n >> 2 & 1));
    text += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    return write_file(folder_ / "box.obj", text);
  }
  std::string made_of(const std::string& surface, const std::string& options = "--nodes 200") const {
    return program("palpate") + " mesh " + surface + " " + options + " -o " + mesh_;
  }
  double volume_made_of(const std::string& surface, const std::string& options = "--nodes 200") const {
    const auto made = run_program(made_of(surface, options));
    EXPECT_EQ(made.status, 0) << made.err;
    return made.status == 0 ? measures_of(load_tet_mesh(mesh_, 1)).volume : 0;
  }
  /// After what is said of progress.
  static void expect_last_words(const std::string& command, const std::string& words) {
    const auto result = run_program(command);
    EXPECT_EQ(result.status, 1) << result.out << result.err;
    EXPECT_NE(result.err.find("palpate: " + words), std::string::npos) << result.err;
  }
  const OwnFolder folder_{"strange"};
  const std::string mesh_ = folder_ / "a.msh";
};

TEST_F(StrangeSizes, BytesOfChanceCalledASurfaceAreRefused) {
  std::mt19937 chance(3);
  for (int i = 0; i < 20; ++i) {
    std::string bytes;
    for (int b = 0; b < 500; ++b) bytes += static_cast<char>(chance());
    const auto result = run_program(made_of(write_file(folder_ / "chance.stl", bytes)));
    EXPECT_EQ(result.status, 1) << i << result.out << result.err;
    EXPECT_NE(result.err.find("chance.stl: "), std::string::npos) << result.err;
  }
}

TEST_F(StrangeSizes, ASizeOfNoBodyIsRefused) {
  for (const double edge : {1e-160, 0.9e-6, 1.1e3, 1e100, 1e300})
    expect_refusal(made_of(box(edge, 0)), {fmt::format("box.obj: it is {:.3g} m across", edge), "--unit"});
  expect_refusal(made_of(box(0.5, 0), "--unit um"), {"it is 5e-07 m across"});
}

TEST_F(StrangeSizes, ABodyFarFromTheOriginIsRefusedWhereItsShapeWouldBeLost) {
  for (const double offset : {1e4, 1e5, 1e6})
    expect_refusal(made_of(box(0.1, offset)), {"box.obj: it lies at (", "from the origin", "move it there"});
  EXPECT_NEAR(volume_made_of(box(0.1, 50)), 1e-3, 1e-6);
}

TEST_F(StrangeSizes, ASurfaceWithoutVolumeIsRefused) {
  const std::string flat = tetrahedron({{{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}}});
  expect_last_words(made_of(flat), flat + ": the surface encloses no volume");
  const std::string line = tetrahedron({{{0, 0, 0}, {0.1, 0, 0}, {0.04, 0, 0}, {0.07, 0, 0}}});
  expect_last_words(made_of(line), line + ": the surface encloses no volume");
}

// Between points that find both sides of a plate no tetrahedron of a rod may have its middle inside.
TEST_F(StrangeSizes, ARodAHundredTimesAsLongAsThickIsFilled) {
  const double volume = volume_made_of(box({1e-3, 1e-3, 0.1}, {0, 0, 0}), "--edge 0.002");
  EXPECT_NEAR(volume, 1e-7, 1e-10);
}

TEST_F(StrangeSizes, LinesOfAnObjFileThatSayNothingOfPolygonsAreTold) {
  const std::string file = box(0.1, 0);
  write_file(file, text_of(file) + "# a word\nmtllib a.mtl\ncurv 0 1\ncurv 1 2\n");
  const auto made = run_program(made_of(file));
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.out.find("lines that say nothing of polygons (2), the first line 17, 'curv': passed over"),
            std::string::npos)
      << made.out;
}

TEST_F(StrangeSizes, SharpEdgesAreNoWalls) {
  const std::string at_corner = tetrahedron({{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}}});
  EXPECT_NEAR(volume_made_of(at_corner), 1e-3 / 6, 1e-6);
  const std::string regular =
      tetrahedron({{{0.05, 0.05, 0.05}, {0.05, -0.05, -0.05}, {-0.05, 0.05, -0.05}, {-0.05, -0.05, 0.05}}});
  EXPECT_NEAR(volume_made_of(regular), 1e-3 / 3, 2e-6);
}

TEST_F(StrangeSizes, ADeviationThatNoSurfaceIsFoundWithinIsRefused) {
  expect_last_words("timeout 60 " + made_of(box(0.1, 0), "--deviation 1e-7"), "a deviation of 0.0001 mm is less than");
}

TEST_F(StrangeSizes, MoreNodesThanAMeshHasAreRefusedAtOnceWithTheirNumber) {
  const std::string surface = box(0.1, 0);
  const std::string edge = program("palpate") + " mesh " + surface + " --edge 1e-7 -o " + mesh_;
  expect_last_words(edge, "edges of 0.0001 mm would be about 6.4e+16 nodes, and a mesh has 3e+06 at most");
  expect_last_words(made_of(surface, "--fine 0.05,0.05,0.05,0.02:1e-5"), "edges of 0.01 mm would be about");
}

}  // namespace
}  // namespace palpate
