#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tools/stability/guarded_run.hpp"
#include "tools/stability/subject.hpp"

/// A scene of a user's, pushed beyond what it was made for.
namespace palpate::stability {
namespace {

class StabilityOfAScene : public ::testing::Test {
 protected:
  StabilityOfAScene() {
    std::filesystem::create_directories(folder_);
    setenv("PALPATE_CACHE", (folder_ / "cache").c_str(), 1);
    write_tet_mesh(make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.03}, {6, 6, 3}), folder_ / "block.msh");
    press(0.003);
  }
  ~StabilityOfAScene() override { std::filesystem::remove_all(folder_); }

  /// The motion: down to a depth [m], across, and up.
  void press(double depth) const {
    std::ofstream(folder_ / "press.csv") << "time,yaw,pitch,depth,roll,grip\n0,0,0,0.26,0,0\n0.1,0,0," << 0.264 + depth
                                         << ",0,0\n0.2,0.08,0," << 0.264 + depth << ",0,0\n0.3,0.08,0,0.25,0,0\n";
  }
  Scene scene(const std::string& model) const {
    std::ofstream(folder_ / "small.toml")
        << "[[body]]\nname = \"block\"\nmesh = \"block.msh\"\nyoung = 4000\npoisson = 0.4\ndensity = 1000\nmodel = \""
        << model
        << "\"\n[[body.fixed]]\ngroup = \"bottom\"\n[[tool]]\nname = \"probe\"\npivot = [0, 0, 0.3]\naxis = [0, 0, "
           "-1]\nup = [0, 1, 0]\n"
           "radius = 0.006\ndevice = \"scripted\"\ntrajectory = \"press.csv\"\n";
    return load_scene(folder_ / "small.toml");
  }
  /// Outcomes of the points whose parameter begins so, by value.
  std::map<std::string, Row> rows(const std::string& model, const std::string& parameter, bool quick) const {
    std::map<std::string, Row> found;
    for (const Point& p : scene_points(scene(model), {.quick = quick}))
      if (p.parameter.starts_with(parameter)) found[p.value] = run_guarded(p);
    return found;
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("stability_scene" + std::to_string(getpid()));
};

TEST_F(StabilityOfAScene, HeldNodesGoAsFarAsTheHapticStepHoldsThem) {
  const auto found = rows("quasi_static", "number", false);
  ASSERT_EQ(found.size(), 7u);
  for (const char* count : {"1", "8", "32", "64", "96"}) {
    EXPECT_EQ(found.at(count).outcome, "stable") << count << ": " << found.at(count).note;
    EXPECT_GT(found.at(count).max_force, 0);
  }
  EXPECT_LT(found.at("96").max_force, found.at("1").max_force * 96);
  for (const char* count : {"256", "512"})
    EXPECT_EQ(found.at(count).note, "a haptic step holds at most 96 contacts of a body") << count;
}

TEST_F(StabilityOfAScene, MovingTissueTakesStepsUpToItsBoundAndRefusesThoseBeyond) {
  const auto found = rows("tensor_mass", "step of moving tissue / bound", false);
  ASSERT_EQ(found.size(), 6u);
  for (const char* of_bound : {"0.1", "0.5", "0.999"})
    EXPECT_EQ(found.at(of_bound).outcome, "stable") << of_bound << ": " << found.at(of_bound).note;
  for (const char* of_bound : {"1.001", "1.5", "10"}) EXPECT_EQ(found.at(of_bound).outcome, "refused") << of_bound;
  EXPECT_GT(found.at("0.999").max_force, 0.01);
  EXPECT_NEAR(found.at("0.1").max_force, found.at("0.999").max_force, 0.1 * found.at("0.1").max_force);
}

TEST_F(StabilityOfAScene, ItsMovingTissueGivesTheSameRowEachTime) {
  const auto once = rows("tensor_mass", "", true), again = rows("tensor_mass", "", true);
  ASSERT_GT(once.size(), 4u);
  for (const auto& [value, row] : once) {
    EXPECT_EQ(row.max_force, again.at(value).max_force) << row.parameter;
    EXPECT_EQ(row.energy_growth, again.at(value).energy_growth) << row.parameter;
    EXPECT_EQ(row.note, again.at(value).note) << row.parameter;
  }
}

/// The scene as it is, with a change.
Row as_it_is(Scene scene, const std::function<void(TensorMassSpec&)>& change) {
  change(std::get<TensorMassSpec>(scene.bodies[0]));
  return run_guarded(scene_points(scene, {.quick = true}).front());
}

TEST_F(StabilityOfAScene, MovingTissueThatIsFlungHasFailedThoughTheHandIsAtRest) {
  const Scene block = scene("tensor_mass");
  const Row row = as_it_is(block, [](TensorMassSpec& body) { body.dynamic.gravity = {0, 0, -2000}; });
  EXPECT_EQ(row.outcome, "failed");
  EXPECT_NE(row.note.find("tissue of 'block': reach over the diagonal"), std::string::npos) << row.note;
  const Row light = as_it_is(block, [](TensorMassSpec& body) { body.dynamic.gravity = {0, 0, -2}; });
  EXPECT_EQ(light.outcome, "stable") << light.note;
}

TEST_F(StabilityOfAScene, RowsHoldForItsMotionItsMeshAndHowMuchIsRun) {
  const Scene one = scene("quasi_static");
  const std::string subject = subject_of(&one, false);
  EXPECT_EQ(subject_of(&one, false), subject);
  EXPECT_NE(subject_of(&one, true), subject);
  EXPECT_NE(subject_of(nullptr, false), subject);
  press(0.004);
  EXPECT_NE(subject_of(&one, false), subject);
  press(0.003);
  EXPECT_EQ(subject_of(&one, false), subject);
  write_tet_mesh(make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.03}, {5, 6, 3}), folder_ / "block.msh");
  EXPECT_NE(subject_of(&one, false), subject);
}

}  // namespace
}  // namespace palpate::stability
