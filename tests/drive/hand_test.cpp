// The emulated hand of `device = "hand"` in lock step: it wants to go where its file says, and gives way.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using nlohmann::json;
using testing::LoopbackScene;
using testing::program;
using testing::run_program;

constexpr double kIntended = 0.205;  ///< [m] depth at which it wants to rest, 13 mm inside the block

/// The block under a hand that presses straight down and stays.
class DriveHand : public ::testing::Test {
 protected:
  DriveHand() {
    scene_.write(
        "motion.csv",
        fmt::format("time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n1,0,0,{0},0,0\n4,0,0,{0},0,0\n", kIntended));
  }

  struct End {
    double depth, force;  ///< [m], [N] on the tool, along z
  };
  /// Where the run ends.
  End run(const std::string& more) const {
    const std::string course = scene_.folder() / "course.csv";
    const auto drive = run_program(fmt::format("{} drive {} --set tool.device=hand --course {} {}", program("palpate"),
                                               scene_.scene(), course, more));
    EXPECT_EQ(drive.status, 0) << drive.err;
    std::string last;
    std::istringstream lines(testing::text_of(course));
    for (std::string line; std::getline(lines, line);)
      if (!line.empty()) last = line;
    double z = 0, fz = 0;
    EXPECT_EQ(std::sscanf(last.c_str(), "%*f,%*f,%*f,%lf,%*f,%*f,%lf", &z, &fz), 2) << last;
    return {0.2 - z, fz};
  }

  LoopbackScene scene_{"hand", testing::kLinear};
};

TEST_F(DriveHand, RestsWhereItsSpringBearsTheForce) {
  for (const double stiffness : {100.0, 400.0}) {
    const End end = run(fmt::format("--set tool.stiffness={}", stiffness));
    EXPECT_GT(end.force, 0.1);
    EXPECT_NEAR(stiffness * (kIntended - end.depth), end.force, 0.002 * end.force) << stiffness << " N/m";
  }
}

TEST_F(DriveHand, AStifferHandGoesDeeperAndAStifferOrganPushesItBack) {
  const double soft = run("--set tool.stiffness=100").depth, stiff = run("--set tool.stiffness=400").depth;
  EXPECT_GT(stiff, soft + 1e-4);
  EXPECT_LT(run("--set tool.stiffness=100 --set body.young=10000").depth, soft - 1e-4);
}

TEST_F(DriveHand, ItsMotionIsTheSystemsOwnAndEndsWithItsFile) {
  const std::string log = scene_.folder() / "hand.lcmlog";
  const auto drive = run_program(
      fmt::format("{} drive {} --set tool.device=hand --json --log {}", program("palpate"), scene_.scene(), log));
  ASSERT_EQ(drive.status, 0) << drive.err;
  EXPECT_NEAR(json::parse(drive.out)["figures"]["seconds"].get<double>(), 4, 0.002);
  const auto verify = run_program(fmt::format("{} replay {} --verify", program("palpate"), log));
  EXPECT_EQ(verify.status, 0) << verify.out << verify.err;
}

}  // namespace
}  // namespace palpate
