#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "tests/study/small_scenes.hpp"
#include "tools/study/press_errors.hpp"
#include "tools/study/study.hpp"

/// What is no number, not measured here, or someone else's is not passed off as a figure.
namespace palpate::study {
namespace {

using namespace testing;
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

PressErrors two_nodes() {
  return {{1, 3},
          Presses{.radius = 0.01,
                  .radius_from = {},
                  .depths = {0.001, 0.002},
                  .patches = {{{1, 2, 3}, {0, 0, -1}, 0}},
                  .nodes = {7}}};
}
PressAnswer answer(double force, double u) {
  return {force, {Eigen::Vector3d(u, 0, 0), Eigen::Vector3d(u, 0, 0)}};
}

TEST(Errors, AreTheRootMeanSquareOfTheRelativeOnesAndKeepTheirSignInEachPress) {
  Result result;
  two_nodes().add({}, {{answer(0.9, 0.8), answer(2.6, 2)}}, {{answer(1, 1), answer(2, 2)}}, "r", result);
  EXPECT_NEAR(result.rows[0].err_f_rel, std::sqrt((0.01 + 0.09) / 2), 1e-12);
  EXPECT_NEAR(result.rows[0].err_u_rel, 0.2 / std::sqrt(2), 1e-12);
  EXPECT_NEAR(result.depths[0].err_f_rel, -0.1, 1e-12);
  EXPECT_NEAR(result.depths[1].err_f_rel, 0.3, 1e-12);
  EXPECT_EQ(result.depths[1].point, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(result.depths[1].normal, (std::array<double, 3>{0, 0, 1})) << "out of the surface";
  EXPECT_EQ(result.depths[1].node, 7);
  Result moving;
  add_course({}, {{1, 2}, {3, 2}}, {{1, 2}, {1, 4}}, 0.5, moving);
  EXPECT_NEAR(moving.rows[0].err_f_rel, std::sqrt(4.0 / 2), 1e-12);
  EXPECT_NEAR(moving.rows[0].err_u_rel, std::sqrt(4.0 / 20), 1e-12);
  EXPECT_EQ(moving.courses[1].time_s, 1);
}

TEST(Errors, APressOrAMomentWithoutANumberIsRefusedAndNotLeftOut) {
  Result result;
  const PressAnswers good{{answer(1, 1), answer(2, 2)}};
  EXPECT_NO_THROW(two_nodes().add({}, good, good, "r", result));
  EXPECT_THROW(two_nodes().add({}, {{answer(1, 1), answer(kNoNumber, 2)}}, good, "r", result), std::runtime_error);
  EXPECT_THROW(two_nodes().add({}, {{answer(1, kNoNumber), answer(2, 2)}}, good, "r", result), std::runtime_error);
  EXPECT_THROW(two_nodes().add({}, {{answer(kNoNumber, 1), answer(2, 2)}}, {{answer(0, 0), answer(2, 2)}}, "r", result),
               std::runtime_error);
  EXPECT_THROW(add_course({}, {{1, 2}, {kNoNumber, 2}}, {{1, 2}, {1, 4}}, 0.5, result), std::runtime_error);
  EXPECT_THROW(add_course({}, {{1, 2}, {3, kNoNumber}}, {{1, 2}, {1, 4}}, 0.5, result), std::runtime_error);
}

TEST(Study, AnInterruptedOneGoesOnWithoutLosingARowAndSaysWhichMachineItsFiguresAreOf) {
  const Folder folder;
  const Scene scene = catheter_scene(folder.at, 10);
  const std::size_t rows = run_study(scene, folder.at / "out", {.quick = true}).rows.size();
  const std::string table = text_of(folder.at / "out/study.csv"), courses = text_of(folder.at / "out/course.csv");
  EXPECT_NE(text_of(folder.at / "out/machine.txt").find("cores"), std::string::npos);
  std::ofstream(folder.at / "out/machine.txt") << "another machine\n";
  run_study(scene, folder.at / "out", {.quick = true});
  EXPECT_EQ(text_of(folder.at / "out/machine.txt"), "another machine\n") << "all points were kept";
  EXPECT_EQ(text_of(folder.at / "out/study.csv"), table);
  EXPECT_EQ(text_of(folder.at / "out/course.csv"), courses);
  for (const auto& file : std::filesystem::directory_iterator(folder.at / "out/points"))
    if (file.path().extension() == ".csv") {
      std::filesystem::remove(file);
      break;
    }
  EXPECT_EQ(run_study(scene, folder.at / "out", {.quick = true}).rows.size(), rows);
  const std::string both = text_of(folder.at / "out/machine.txt");
  EXPECT_TRUE(both.starts_with("another machine\n") && both.find("cores") != std::string::npos) << both;
}

TEST(Study, FilesThatAreNotItsOwnStay) {
  const Folder folder;
  const Scene scene = catheter_scene(folder.at, 10);
  std::filesystem::create_directories(folder.at / "a");
  std::ofstream(folder.at / "a/study.csv") << "my,own,figures\n";
  EXPECT_THROW(run_study(scene, folder.at / "a", {.quick = true}), std::runtime_error);
  EXPECT_EQ(text_of(folder.at / "a/study.csv"), "my,own,figures\n");
  std::filesystem::create_directories(folder.at / "b/points");
  std::ofstream(folder.at / "b/points/mine.txt") << "precious\n";
  EXPECT_THROW(run_study(scene, folder.at / "b", {.quick = true}), std::runtime_error);
  EXPECT_EQ(text_of(folder.at / "b/points/mine.txt"), "precious\n");
  EXPECT_THROW(run_study(scene, folder.at / "small.toml", {.quick = true}), std::runtime_error);
}

}  // namespace
}  // namespace palpate::study
