// What a film of a log shows of tissue that comes apart.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tools/program_result.hpp"
#include "tools/film/log_pictures.hpp"
#include "tools/logs/log_files.hpp"

namespace palpate {
namespace {

/// [m] the longest edge that is drawn of tissue.
float longest_edge(const Frame& frame) {
  float longest = 0;
  for (const MeshView& mesh : frame.meshes)
    if (mesh.finish == Finish::tissue)
      for (const auto& t : mesh.triangles)
        for (int side = 0; side < 3; ++side)
          longest = std::max(longest, (mesh.position[t[side]] - mesh.position[t[(side + 1) % 3]]).norm());
  return longest;
}

// The lower part is 30 mm away after 3 s: were what has torn still drawn, its triangles would span the gap.
TEST(FilmOfACut, DrawsNothingAcrossWhatHasTorn) {
  const testing::OwnFolder folder("film-cut");
  const auto log = folder / "torn.lcmlog";
  const auto run = testing::run_program(
      fmt::format("{} drive {}/scenes/cylinder_tear_alone.toml --seconds 3 --expect \"body.torn>50\" --log {}",
                  testing::program("palpate"), PALPATE_SOURCE, log.string()));
  ASSERT_EQ(run.status, 0) << run.err;
  const LoggedScene logged(log, {});
  logged.ensure_archives();
  LogPictures pictures(log, contents_of(log, logged.scene()), logged.scene());
  EXPECT_LT(longest_edge(pictures.at(0.1)), 0.006f);
  EXPECT_LT(longest_edge(pictures.at(3)), 0.006f);
}

}  // namespace
}  // namespace palpate
