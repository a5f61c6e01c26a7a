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
TEST(RealLiver, BecomesASceneWithItsVolumesInOnePieceEach) {
  const OwnFolder folder("real-liver");
  constexpr const char* kArchive = "/usr/share/doc/libcgal-dev/data.tar.gz";
  std::string image = std::getenv("PALPATE_LIVER") != nullptr ? std::getenv("PALPATE_LIVER") : "";
  if (image.empty() && std::filesystem::exists(kArchive)) {
    image = folder / "data/images/liver.inr.gz";
    run_program(fmt::format("tar -xzf {} -C {} data/images/liver.inr.gz", kArchive, folder.path().string()));
  }
  if (!std::filesystem::exists(image))
    GTEST_SKIP() << "no liver: Debian's libcgal-demo has one, or PALPATE_LIVER names it";
  const std::string mesh = folder / "organ.msh", scene = folder / "organ.toml";
  const std::string said = folder / "said";
  ASSERT_EQ(run_command(fmt::format("timeout 600 {} organ {} --label 255=liver --label 85=gall_bladder "
                                    "--group attachment=above:z -o {} >{} 2>&1",
                                    program("palpate"), image, mesh, said)),
            0)
      << text_of(said);
  const TetMesh organ = load_tet_mesh(mesh, 1);
  EXPECT_GE(measures_of(organ).min_angle, 12);
  for (const auto& [name, volume] : {std::pair{"liver", 1.605e-3}, {"gall_bladder", 8.991e-6}}) {
    TetMesh part{organ.nodes, {}, {}};
    for (const int t : organ.groups.at(name).tetrahedra) part.tetrahedra.push_back(organ.tetrahedra[t]);
    EXPECT_NEAR(measures_of(part).volume, volume, 0.01 * volume) << name;
    EXPECT_EQ(pieces_of(part).size(), 1u) << name;
    EXPECT_EQ(topology_of(part), (Topology{1, 0})) << name;
  }
  const std::string out = text_of(said);
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

}  // namespace
}  // namespace palpate
