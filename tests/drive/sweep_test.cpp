#include "tools/drive/sweep.hpp"

#include <gtest/gtest.h>

#include "tests/tools/program_result.hpp"
#include "tools/shared/shell_line.hpp"

namespace palpate::drive {
namespace {

TEST(DriveSweep, TakesEveryCombinationInOrder) {
  const auto points = grid({{"a", "0"}}, {parse_axis("b=1,2"), parse_axis("c=[1,2],\"x,y\"")});
  ASSERT_EQ(points.size(), 4u);
  std::string text;
  for (const auto& point : points)
    for (const SceneChange& change : point) text += change.argument() + " ";
  EXPECT_EQ(text, "a=0 b=1 c=[1,2] a=0 b=1 c=\"x,y\" a=0 b=2 c=[1,2] a=0 b=2 c=\"x,y\" ");
  EXPECT_EQ(grid({{"a", "0"}}, {}).size(), 1u);
}

TEST(DriveSweep, OfNothingOrTooMuchIsRefused) {
  for (const char* bad : {"b", "b=", "b=1,", "b=,1", "b=1,,2"})
    EXPECT_THROW(parse_axis(bad), std::runtime_error) << bad;
  std::string thousand = "b=0";
  for (int i = 1; i < 1000; ++i) thousand += "," + std::to_string(i);
  std::string other = thousand;
  other[0] = 'c';
  EXPECT_THROW(grid({}, {parse_axis(thousand), parse_axis(other)}), std::runtime_error);
  EXPECT_THROW(grid({}, {parse_axis("b=1,2"), parse_axis("c=1"), parse_axis("b=3")}), std::runtime_error);
}

TEST(DriveSweep, CommandsReachAShellAsTheyAre) {
  const std::vector<std::string> words{"/bin/echo", "a b", "it's", "x<3", "", "$HOME", "[1,2]", "\"q\""};
  std::string out;
  ASSERT_EQ(testing::run_command(shell_line(words), &out), 0);
  EXPECT_EQ(out, "a b it's x<3  $HOME [1,2] \"q\"\n");
}

TEST(DriveSweep, APointWhoseProcessDiesHasFailed) {
  const auto results =
      run_points({{"/bin/sh", "-c", "kill -9 $$"}, {"/bin/sh", "-c", "exit 3"}}, 2, [](const auto&) {});
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].outcome, PointResult::kFailed);
  EXPECT_EQ(results[0].reason, "its process ended with status 137 and no result");
  EXPECT_EQ(results[1].reason, "its process ended with status 3 and no result");
}

}  // namespace
}  // namespace palpate::drive
