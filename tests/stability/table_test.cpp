#include "tools/stability/table.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace palpate::stability {
namespace {

class StabilityTable : public ::testing::Test {
 protected:
  ~StabilityTable() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path csv() const { return folder_ / "stability.csv"; }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("stability" + std::to_string(getpid()));
};

Point stable(const std::string& name, double force) {
  return {.name = name, .parameter = "p", .value = "1", .run = [force] {
            return Result{.max_force = force, .note = "x, y"};
          }};
}
Point failing(const std::string& name) {
  return {.name = name, .parameter = "p", .value = "1", .run = [] {
            return Result{.outcome = Outcome::failed, .note = {}};
          }};
}

TEST_F(StabilityTable, ARunGoesOnWhereItWasRepeatsWhatFailedAndBeginsAnewForAnotherSubject) {
  EXPECT_EQ(run_table({stable("a,b", 1), failing("c")}, folder_, "one"), 1);
  EXPECT_EQ(run_table({stable("a,b", 2), stable("c", 3)}, folder_, "one"), 0);
  const auto rows = read_rows(csv());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].name, "a,b");
  EXPECT_EQ(rows[0].note, "x, y");
  EXPECT_EQ(rows[0].max_force, 1) << "kept";
  EXPECT_EQ(rows[1].max_force, 3) << "run again";
  run_table({stable("a,b", 2)}, folder_, "two");
  EXPECT_EQ(read_rows(csv())[0].max_force, 2) << "another subject";
}

TEST_F(StabilityTable, PointsThatWereRunAloneAreTakenIntoTheTable) {
  const std::vector<Point> alone{stable("a", 1), failing("b"), stable("c", 3)};
  for (const std::size_t point : {1, 2})
    run_table(alone, folder_of_point(folder_, point), point == 1 ? "one" : "of another program", {.point = point});
  const std::vector<Point> all{stable("a", 10), stable("b", 20), stable("c", 30)};
  EXPECT_EQ(run_table(all, folder_, "one"), 1) << "it is not run again at once";
  const auto rows = read_rows(csv());
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].max_force, 10) << "was still to be run";
  EXPECT_EQ(rows[1].outcome, "failed");
  EXPECT_EQ(rows[2].max_force, 30) << "of another subject";
  EXPECT_EQ(run_table(all, folder_, "one"), 0) << "and then it is";
  EXPECT_THROW(run_table(all, folder_, "one", {.point = 3}), std::runtime_error);
}

TEST_F(StabilityTable, EachValueOfAParameterHasItsOwnRow) {
  const auto at = [](const std::string& value, double force) {
    return Point{.name = "press", .parameter = "depth", .value = value, .run = [force] {
                   return Result{.max_force = force, .note = {}};
                 }};
  };
  run_table({at("1", 1)}, folder_, "one");
  run_table({at("1", 10), at("2", 20)}, folder_, "one");
  const auto rows = read_rows(csv());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].max_force, 1);
  EXPECT_EQ(rows[1].max_force, 20);
}

TEST_F(StabilityTable, RunningSomeCasesAloneKeepsTheRowsOfTheOthers) {
  run_table({stable("wall", 1), stable("shell", 2), stable("wall of tissue", 3)}, folder_, "one");
  EXPECT_EQ(run_table({failing("wall"), stable("shell", 5), stable("wall of tissue", 6), stable("shell too", 7)},
                      folder_, "one", {.only = "shell"}),
            0);
  std::vector<std::string> names;
  for (const Row& r : read_rows(csv())) names.push_back(r.name);
  EXPECT_EQ(names, (std::vector<std::string>{"wall", "shell", "wall of tissue", "shell too"}));
  EXPECT_THROW(run_table({stable("wall", 1)}, folder_, "one", {.only = "nothing of that name"}), std::runtime_error);
}

TEST_F(StabilityTable, SeveralRunAtTheSameTimeAndStandInTheirOrder) {
  const auto said = folder_ / "said by the second";
  const Point first{.name = "first", .parameter = "p", .value = "1", .run = [said] {
                      while (!std::filesystem::exists(said)) usleep(1000);
                      return Result{.max_force = 1, .note = {}};
                    }};
  const Point second{.name = "second", .parameter = "p", .value = "1", .run = [said] {
                       std::ofstream(said) << "go on";
                       return Result{.max_force = 2, .note = {}};
                     }};
  EXPECT_EQ(run_table({first, second, stable("third", 3)}, folder_, "one", {.jobs = 2}), 0);
  const auto rows = read_rows(csv());
  ASSERT_EQ(rows.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rows[i].max_force, i + 1);
}

TEST_F(StabilityTable, AnInterruptionCostsNoRowThatWasThere) {
  run_table({failing("first"), stable("second", 2)}, folder_, "one");
  const pid_t child = fork();
  if (child == 0) {
    run_table({{.name = "first",
                .parameter = "p",
                .value = "1",
                .run = []() -> Result {
                  sleep(2);
                  return {};
                }},
               stable("second", 5)},
              folder_, "one");
    _exit(0);
  }
  usleep(300000);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const auto rows = read_rows(csv());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].max_force, 2);
}

TEST_F(StabilityTable, WhatIsKnownToFailCountsNoMore) {
  std::filesystem::create_directories(folder_);
  const auto list = folder_ / "known.txt";
  const Point one = failing("one"), two = failing("two");
  std::ofstream(list) << "# why these fail\n\none | " << one.parameter << " | " << one.value << " | a reason\n";
  const std::vector<Point> points{one, two, stable("three", 3)};
  EXPECT_EQ(run_table({one, stable("three", 3)}, folder_, "one", {.known = list}), 0);
  EXPECT_EQ(run_table(points, folder_, "one", {.known = list}), 1) << "the second is new";
  EXPECT_EQ(run_table(points, folder_, "one"), 2);
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_table({stable("one", 1), two}, folder_, "two", {.known = list}), 1);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("known to fail, and does not: one | "), std::string::npos);
  std::ofstream(list) << "one | reason\n";
  EXPECT_THROW(run_table(points, folder_, "one", {.known = list}), std::runtime_error);
  EXPECT_THROW(run_table(points, folder_, "one", {.known = folder_ / "none"}), std::runtime_error);
}

TEST_F(StabilityTable, ATableOfSomethingElseStaysAsItIs) {
  std::filesystem::create_directories(folder_);
  std::ofstream(csv()) << "my,own,figures\n1,2,3\n";
  EXPECT_THROW(run_table({stable("a", 1)}, folder_, "one"), std::runtime_error);
  std::ifstream in(csv());
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "my,own,figures");
  EXPECT_THROW(run_table({stable("a", 1)}, csv() / "below a file", "one"), std::runtime_error);
}

}  // namespace
}  // namespace palpate::stability
