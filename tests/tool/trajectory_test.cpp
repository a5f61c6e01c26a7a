#include "common/tool/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "common/scene/scene.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

class TrajectoryFile : public ::testing::Test {
 protected:
  TrajectoryFile() {
    char name[] = "/tmp/palpate_trajectory_XXXXXX";
    folder_ = mkdtemp(name);
  }
  ~TrajectoryFile() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file(const std::string& text) const {
    std::ofstream(folder_ / "move.csv") << text;
    return folder_ / "move.csv";
  }
  std::string refusal(const std::string& text) const {
    try {
      load_trajectory(file(text));
    } catch (const std::runtime_error& error) {
      return std::string(error.what()).substr((folder_ / "move.csv").string().size());
    }
    return "accepted";
  }

 private:
  std::filesystem::path folder_;
};

const std::string kHeader = "time,yaw,pitch,depth,roll,grip\n";
const std::string kRows = "0,0,0,0.1,0,0\n0.5,0.2,-0.1,0.15,1,0.3\n1,0.2,-0.3,0.15,0,0\n2,0.5,-0.35,0.05,2,0\n";

TEST_F(TrajectoryFile, PassesThroughItsRows) {
  const Trajectory move = load_trajectory(file("# a comment\n" + kHeader + kRows));
  EXPECT_EQ(move.duration(), 2);
  const ToolDofs at = move.at(0.5);
  EXPECT_EQ(at.yaw, 0.2);
  EXPECT_EQ(at.pitch, -0.1);
  EXPECT_EQ(at.depth, 0.15);
  EXPECT_EQ(at.roll, 1);
  EXPECT_EQ(at.grip, 0.3);
  EXPECT_EQ(move.at(2).yaw, 0.5);
}

TEST_F(TrajectoryFile, HoldsTheFirstAndTheLastPose) {
  const Trajectory move = load_trajectory(file(kHeader + "1,0.1,0,0,0,0\n2,0.2,0,0,0,0\n"));
  EXPECT_EQ(move.at(-5).yaw, 0.1);
  EXPECT_EQ(move.at(0.9).yaw, 0.1);
  EXPECT_EQ(move.at(100).yaw, 0.2);
  EXPECT_EQ(move.at(std::nan("")).yaw, 0.1);
}

TEST_F(TrajectoryFile, SpeedIsContinuousAndNothingOvershoots) {
  const Trajectory move = load_trajectory(file(kHeader + kRows));
  const double h = 1e-5;
  for (double t : {0.5, 1.0}) {
    const double left = (move.at(t).depth - move.at(t - h).depth) / h;
    const double right = (move.at(t + h).depth - move.at(t).depth) / h;
    EXPECT_NEAR(left, right, 1e-4);
    EXPECT_NEAR((move.at(t).pitch - move.at(t - h).pitch) / h, (move.at(t + h).pitch - move.at(t).pitch) / h, 1e-4);
  }
  for (double t = 0; t <= 2; t += 1e-3) {
    ASSERT_LE(move.at(t).depth, 0.15);
    ASSERT_GE(move.at(t).depth, 0.05);
    if (t >= 0.5 && t <= 1) {
      ASSERT_EQ(move.at(t).depth, 0.15);  // rests between equal rows
    }
  }
}

TEST_F(TrajectoryFile, ThePedalIsASwitchThatStaysWhereTheLastRowPutIt) {
  const Trajectory move = load_trajectory(
      file("time,yaw,pitch,depth,roll,grip,pedal\n0,0,0,0.1,0,0,0\n1,0,0,0.2,0,0,1\n2,0,0,0.2,0,0,0\n"));
  for (double t : {-1.0, 0.0, 0.5, 0.999}) EXPECT_EQ(move.at(t).pedal, 0) << t;
  for (double t : {1.0, 1.5, 1.999}) EXPECT_EQ(move.at(t).pedal, 1) << t;
  for (double t : {2.0, 9.0}) EXPECT_EQ(move.at(t).pedal, 0) << t;
  EXPECT_NEAR(move.at(0.5).depth, 0.15, 1e-12);
  EXPECT_EQ(load_trajectory(file(kHeader + kRows)).at(0.7).pedal, 0);
}

TEST_F(TrajectoryFile, OneRowIsAToolThatRests) {
  const Trajectory rest = load_trajectory(file(kHeader + "0,0.1,0.2,0.3,0.4,0.5\n"));
  EXPECT_EQ(rest.duration(), 0);
  EXPECT_EQ(rest.at(3).depth, 0.3);
}

TEST_F(TrajectoryFile, EvaluationAllocatesNothing) {
  const Trajectory move = load_trajectory(file(kHeader + kRows));
  const long before = allocations();
  double sum = 0;
  for (int i = 0; i < 1000; ++i) sum += move.at(0.003 * i).yaw;
  EXPECT_EQ(allocations(), before);
  EXPECT_GT(sum, 0);
}

TEST_F(TrajectoryFile, RefusesWithTheLine) {
  EXPECT_EQ(refusal("t,yaw,pitch,depth,roll,grip\n0,0,0,0,0,0\n"),
            ":1: the header must be 'time,yaw,pitch,depth,roll,grip' or "
            "'time,yaw,pitch,depth,roll,grip,pedal'");
  EXPECT_EQ(refusal(""),
            ":1: the header 'time,yaw,pitch,depth,roll,grip' or "
            "'time,yaw,pitch,depth,roll,grip,pedal' is missing");
  EXPECT_EQ(refusal("time,yaw,pitch,depth,roll,grip,pedal\n0,0,0,0.1,0,0,0.5\n"),
            ":2: pedal must be 0 or 1, and is 0.5");
  EXPECT_EQ(refusal("time,yaw,pitch,depth,roll,grip,pedal\n0,0,0,0.1,0,0\n"),
            ":2: 7 columns are needed, and there are 6");
  EXPECT_EQ(refusal(kHeader), ":1: there is no row of numbers");
  EXPECT_EQ(refusal(kHeader + "0,0,0,0.1,0,0\n1,0,nan,0.1,0,0\n"), ":3: 'nan' is not a finite number");
  EXPECT_EQ(refusal(kHeader + "0,0,0,0.1,0\n"), ":2: 6 columns are needed, and there are 5");
  EXPECT_EQ(refusal(kHeader + "0,0,0,0.1,0,0\n# c\n0,0,0,0.1,0,0\n"), ":4: time 0 does not come after 0");
  EXPECT_EQ(refusal(kHeader + "1,0,0,0.1,0,0\n0.5,0,0,0.1,0,0\n"), ":3: time 0.5 does not come after 1");
}

TEST(Trajectory, RefusesRowsThatAreNotOne) {
  EXPECT_THROW(Trajectory({}, {}), std::invalid_argument);
  EXPECT_THROW(Trajectory({0, 1}, {ToolDofs{}}), std::invalid_argument);
  EXPECT_THROW(Trajectory({0, 0}, {ToolDofs{}, ToolDofs{}}), std::invalid_argument);
}

TEST_F(TrajectoryFile, AForcepsGripsWithinTheRangeOfItsJaws) {
  Tool tool;
  tool.name = "hand";
  tool.end = ForcepsSpec{{.max_open = 0.8}};
  const std::filesystem::path good = file(kHeader + "0,0,0,0.1,0,0\n1,0,0,0.1,0,0.8\n2,0,0,0.1,0,0.1\n");
  EXPECT_NO_THROW(check_grip(load_trajectory(good), good, tool));
  const auto refusal_of = [&](const std::string& text) -> std::string {
    try {
      check_grip(load_trajectory(file(text)), good, tool);
    } catch (const std::runtime_error& error) {
      return std::string(error.what()).substr(good.string().size());
    }
    return "accepted";
  };
  EXPECT_EQ(refusal_of(kHeader + "0,0,0,0.1,0,0\n1.5,0,0,0.1,0,0.81\n"),
            ": the grip of 0.81 rad at 1.5 s is out of range: the jaws of 'hand' open from 0 to 0.8 rad");
  EXPECT_EQ(refusal_of(kHeader + "0,0,0,0.1,0,-0.01\n"),
            ": the grip of -0.01 rad at 0 s is out of range: the jaws of 'hand' open from 0 to 0.8 rad");
  tool.end = ProbeSpec{.jaws = ClosingJaws{}};  // its jaws have no such range
  EXPECT_EQ(refusal_of(kHeader + "0,0,0,0.1,0,1.5\n"), "accepted");
}

TEST(Trajectory, ThoseOfTheExampleScenesLoad) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PALPATE_SOURCE_DIR "/scenes/trajectories")) {
    const Trajectory move = load_trajectory(entry.path());
    EXPECT_GE(move.duration(), 5) << entry.path();
    EXPECT_GT(move.at(0).depth, 0.05) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 5);
}

}  // namespace
}  // namespace palpate
