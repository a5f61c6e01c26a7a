#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>

#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/organ/mesh_pieces.hpp"

namespace palpate {
namespace {

using namespace palpate::testing;

// Debian's libcgal-demo has a labelled liver; where it is not installed, PALPATE_LIVER may name images/liver.inr.gz.
class RealLiver : public ::testing::Test {
 protected:
  void SetUp() override {
    constexpr const char* kArchive = "/usr/share/doc/libcgal-dev/data.tar.gz";
    if (std::getenv("PALPATE_LIVER") != nullptr) image_ = std::getenv("PALPATE_LIVER");
    if (image_.empty() && std::filesystem::exists(kArchive)) {
      image_ = folder_ / "data/images/liver.inr.gz";
      run_program(fmt::format("tar -xzf {} -C {} data/images/liver.inr.gz", kArchive, folder_.path().string()));
    }
    if (!std::filesystem::exists(image_))
      GTEST_SKIP() << "no liver: Debian's libcgal-demo has one, or PALPATE_LIVER names it";
  }
  /// What `palpate organ` says of these labels.
  std::string organ(const std::string& labels, const std::string& mesh) const {
    const std::string said = folder_ / "said";
    EXPECT_EQ(run_command(fmt::format("timeout 600 {} organ {} {} -o {} >{} 2>&1", program("palpate"), image_, labels,
                                      mesh, said)),
              0)
        << text_of(said);
    return text_of(said);
  }
  static TetMesh part_of(const TetMesh& organ, const std::string& name) {
    TetMesh part{organ.nodes, {}, {}};
    for (const int t : organ.groups.at(name).tetrahedra) part.tetrahedra.push_back(organ.tetrahedra[t]);
    return part;
  }
  static void expect_one_piece(const TetMesh& part, const char* name, double volume) {
    EXPECT_NEAR(measures_of(part).volume, volume, 0.01 * volume) << name;
    EXPECT_EQ(pieces_of(part).size(), 1u) << name;
    EXPECT_EQ(topology_of(part), (Topology{1, 0})) << name;
  }
  const OwnFolder folder_{"real-liver"};
  std::string image_;
};

TEST_F(RealLiver, BecomesASceneWithItsVolumesInOnePieceEach) {
  const std::string mesh = folder_ / "organ.msh", scene = folder_ / "organ.toml";
  const std::string both = "--label 255=liver --label 85=gall_bladder --group attachment=above:z";
  const std::string out = organ(both, mesh);
  const TetMesh body = load_tet_mesh(mesh, 1);
  EXPECT_GE(measures_of(body).min_angle, 12);
  expect_one_piece(part_of(body, "liver"), "liver", 1.605e-3);
  expect_one_piece(part_of(body, "gall_bladder"), "gall bladder", 8.991e-6);
  if (std::getenv("PALPATE_LONG_TESTS")) {
    organ(both, folder_ / "again.msh");
    EXPECT_TRUE(text_of(mesh) == text_of(folder_ / "again.msh"));
  }
  const std::regex distances("in voxel diagonals ([0-9.]+), ([0-9.]+), ([0-9.]+)");
  int labels = 0;
  for (std::sregex_iterator match(out.begin(), out.end(), distances); match != std::sregex_iterator(); ++match) {
    ++labels;
    EXPECT_LE(std::stod((*match)[1]), 0.3) << "mean\n" << out;
    EXPECT_LE(std::stod((*match)[2]), 1) << "99 %\n" << out;
    EXPECT_LE(std::stod((*match)[3]), 2.4) << "largest\n" << out;
  }
  EXPECT_EQ(labels, 2) << out;
  EXPECT_EQ(run_program(program("palpate") + " scene " + mesh + " --tissue liver -o " + scene).status, 0);
  EXPECT_EQ(run_program(program("palpate") + " check " + scene).status, 0);
}

TEST_F(RealLiver, ItsGallBladderAndTheRightKidneyAreApartAndHaveAMeshEach) {
  organ("--label 85=gall_bladder --label 127=right_kidney --nodes 400", folder_ / "organ.msh");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "organ.msh"));
  for (const auto& [name, volume] : {std::pair{"gall_bladder", 8.991e-6}, {"right_kidney", 1.60e-4}}) {
    const TetMesh body = load_tet_mesh(folder_ / fmt::format("organ_{}.msh", name), 1);
    EXPECT_GE(measures_of(body).min_angle, 12) << name;
    expect_one_piece(body, name, volume);
  }
}

}  // namespace
}  // namespace palpate
