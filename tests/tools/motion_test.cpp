// Motions made of steps.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/tool/trajectory.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/motion/motion_rows.hpp"
#include "tools/motion/motion_step.hpp"
#include "tools/motion/tip_path.hpp"

namespace palpate {
namespace {

using testing::expect_refusal;
using testing::LoopbackScene;
using testing::program;
using testing::run_program;

TEST(MotionSteps, AreReadWithTheirUnits) {
  using Kind = MotionStep::Kind;
  const MotionStep to = parse_motion_step("to 20mm,-1cm,0.06");
  EXPECT_EQ(to.kind, Kind::to);
  EXPECT_LT((to.place - Eigen::Vector3d(0.02, -0.01, 0.06)).norm(), 1e-15);
  EXPECT_EQ(parse_motion_step("press 4mm").value, 0.004);
  EXPECT_EQ(parse_motion_step("press 0.5N").kind, Kind::press_with);
  EXPECT_EQ(parse_motion_step("press 0.5 N").value, 0.5);
  EXPECT_EQ(parse_motion_step("hold 1s").value, 1);
  EXPECT_EQ(parse_motion_step("withdraw").kind, Kind::withdraw);
  for (const char* wrong : {"", "to", "to 1,2", "to 1,2,3,4", "to 1,2,3feet", "press", "press -1mm", "press 1s",
                            "hold 0", "hold 1h", "grip 4", "pedal 2", "withdraw 3", "press nan", "to inf,0,0", "dance"})
    EXPECT_THROW(parse_motion_step(wrong), std::runtime_error) << wrong;
}

// From rest to rest, at no more than the speed that was asked for.
TEST(MotionSteps, AWayIsGoneGently) {
  const Trocar trocar = make_trocar({0, 0, 0.2}, {0, 0, -1}, {0, 1, 0});
  MotionRows rows(trocar, 0, {0, 0, 0});
  rows.go({{0.03, 0, 0}, {0.07, 0, 0}}, 0.05);
  const Trajectory motion = rows.trajectory();
  const double dt = 1e-3, duration = motion.duration();
  EXPECT_NEAR(duration, 1.875 * 0.07 / 0.05, 1e-9);
  double fastest = 0, first = 0, length = 0;
  Eigen::Vector3d before(0, 0, 0);
  for (double t = dt; t <= duration; t += dt) {
    const Eigen::Vector3d tip = tip_pose(trocar, motion.at(t)).translation();
    const double speed = (tip - before).norm() / dt;
    if (t < 2 * dt) first = speed;
    fastest = std::max(fastest, speed);
    length += (tip - before).norm();
    before = tip;
  }
  EXPECT_LT(first, 1e-3);
  EXPECT_NEAR(fastest, 0.05, 1e-3);
  EXPECT_NEAR(length, 0.07, 1e-5);
  EXPECT_LT((before - Eigen::Vector3d(0.07, 0, 0)).norm(), 1e-5);
}

TEST(TipPath, StandsWhereAStepBeginsAndEnds) {
  const Trocar trocar = make_trocar({0, 0, 0.2}, {0, 0, -1}, {0, 1, 0});
  const std::array<Eigen::Vector3d, 4> places{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.03, 0, 0),
                                              Eigen::Vector3d(0.03, 0.02, 0), Eigen::Vector3d(0.03, 0.02, 0.04)};
  MotionRows rows(trocar, 0, places[0]);
  rows.go({places[1]}, 0.05);
  rows.stand(0.2);
  rows.go({places[2]}, 0.05);
  rows.go({places[3]}, 0.05);
  const TipPath path = tip_path(trocar, 0, rows.trajectory());
  ASSERT_EQ(path.stands.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_LT((path.stands[i] - places[i]).norm(), 5e-4) << i;
  double length = 0;
  for (std::size_t i = 1; i < path.points.size(); ++i) length += (path.points[i] - path.points[i - 1]).norm();
  EXPECT_NEAR(length, 0.09, 1e-3);
}

/// A row of the table that the command prints [s, N].
struct StepFelt {
  double from = 0, to = 0, largest = 0, end = 0;
};
StepFelt felt_in(const std::string& table, const std::string& step) {
  StepFelt felt;
  const std::size_t found = table.find(step), line = found == std::string::npos ? 0 : table.rfind('\n', found) + 1;
  EXPECT_EQ(std::sscanf(table.c_str() + line, "%lf %lf %lf %lf", &felt.from, &felt.to, &felt.largest, &felt.end), 4)
      << step << " in " << table;
  return felt;
}

class ToolsMotion : public ::testing::Test {
 protected:
  std::string motion(const std::string& steps) const {
    return fmt::format("{} motion {} {} -o {}", program("palpate"), scene_.scene(), steps,
                       (scene_.folder() / "made.csv").string());
  }
  LoopbackScene scene_{"motion", testing::kLinear};
};

TEST_F(ToolsMotion, OneThatTouchesNothingIsMadeAndSoItIsSaid) {
  const auto made = run_program(motion("\"to 0,0,1\" \"hold 0.1s\""));
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.err.find("made.csv: the tool touches nothing on all of its way"), std::string::npos) << made.err;
}

TEST_F(ToolsMotion, ForcesAndDepthsAreWhatTheStepsSay) {
  const auto made = run_program(motion(
      "\"to 0,0,1\" \"press 3mm\" \"hold 0.2s\" withdraw \"press 0.1N\" \"hold 0.5s\" \"slide 4mm,0,1\" withdraw"));
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(made.err.find("touches nothing"), std::string::npos) << made.err;
  EXPECT_EQ(std::count(made.out.begin(), made.out.end(), '\n'), 10) << made.out;
  const auto run = run_program(
      fmt::format("{} drive {} --set tool.probe.trajectory=made.csv --json", program("palpate"), scene_.scene()));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto figures = nlohmann::json::parse(run.out)["figures"];
  EXPECT_EQ(figures["tool.probe.touches"], 2);
  EXPECT_LT(figures["tool.probe.force.change"].get<double>(), 0.02);
  // In the middle of the hold: the force that was asked for; it stays about that on the way along the surface.
  const StepFelt held = felt_in(made.out, "hold 0.5s"), slid = felt_in(made.out, "slide 4mm");
  EXPECT_NEAR(held.to - held.from, 0.5, 0.011);
  EXPECT_NEAR(held.end, 0.1, 0.002);
  EXPECT_NEAR(slid.end, 0.1, 0.03);
}

TEST_F(ToolsMotion, WhereMoreIsFeltThanAskedForThePressGoesBack) {
  const auto made =
      run_program(motion("\"to 0,0,1\" \"press 5mm\" \"press 0.05N\" \"hold 0.1s\" \"press 0.1N\" withdraw"));
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(made.err, "");
  EXPECT_GT(felt_in(made.out, "press 5mm").end, 0.12) << made.out;
  EXPECT_NEAR(felt_in(made.out, "press 0.05N").end, 0.05, 0.001) << made.out;
  EXPECT_NEAR(felt_in(made.out, "hold 0.1s").end, 0.05, 0.001) << made.out;
  EXPECT_NEAR(felt_in(made.out, "press 0.1N").end, 0.1, 0.002) << made.out;
}

// With the joint for its tip the jaws, 20 mm long, would be within the duct where they are to stand clear of it.
TEST(ToolsMotionForceps, TheEndsOfShutJawsAreTheTipAndTheTableIsOfWhatIsWritten) {
  const testing::OwnFolder folder("motion-forceps");
  setenv("PALPATE_CACHE", (folder / "cache").c_str(), 1);
  const std::string scene = PALPATE_SOURCE "/scenes/duct_poke.toml", file = folder / "made.csv";
  const auto made = run_program(
      fmt::format("{} motion {} \"to -20mm,-5mm,6mm\" \"press 3mm\" \"slide -5mm,-5mm,6mm\" withdraw --json -o {}",
                  program("palpate"), scene, file));
  ASSERT_EQ(made.status, 0) << made.err;
  const auto steps = nlohmann::json::parse(made.out)["steps"];
  EXPECT_GT(steps[1]["end_force_n"].get<double>(), 0.05);
  EXPECT_LT(steps[1]["end_force_n"].get<double>(), 0.3);
  const auto run =
      run_program(fmt::format("{} drive {} --set tool.forceps.trajectory={} --json", program("palpate"), scene, file));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto figures = nlohmann::json::parse(run.out)["figures"];
  EXPECT_DOUBLE_EQ(figures["tool.forceps.force.max"].get<double>(), steps[2]["max_force_n"].get<double>());
}

// On its quick way the tool feels the tissue's inertia and damping too: when it stands, about half as much is left.
TEST(ToolsMotionMoving, AForceIsMetWhereItStands) {
  const LoopbackScene scene("motion_moving", "[body.dynamic]\ndamping = 20\n", 1000);
  scene.replace("quasi_static", "tensor_mass");
  scene.replace("radius = 0.008", "radius = 0.016");
  const auto made = run_program(fmt::format("{} motion {} --speed 0.2 \"to 0,0,1\" \"press 0.05N\" \"hold 0.5s\" -o {}",
                                            program("palpate"), scene.scene(), (scene.folder() / "made.csv").string()));
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(made.err.find("the force at its end"), std::string::npos) << made.err;
  EXPECT_NEAR(felt_in(made.out, "press 0.05N").end, 0.05, 0.0025) << made.out;
  EXPECT_NEAR(felt_in(made.out, "hold 0.5s").end, 0.05, 0.0025) << made.out;
}

// Let go at first, the tissue sinks under its weight and swings back to the tip, which it does not reach at rest.
TEST(ToolsMotionMoving, AForceThatIsMissedIsToldOf) {
  const LoopbackScene scene("motion_missed", "[body.dynamic]\ndamping = 2\ngravity = [0, 0, -9.81]\n", 2000);
  scene.replace("quasi_static", "tensor_mass");
  scene.replace("radius = 0.008", "radius = 0.001");
  const auto made = run_program(fmt::format("{} motion {} --speed 0.1 \"to 0,0,1\" \"press 0.008N\" -o {}",
                                            program("palpate"), scene.scene(), (scene.folder() / "made.csv").string()));
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.err.find("palpate: 'press 0.008N': the force at its end is "), std::string::npos) << made.err;
  EXPECT_NE(made.err.find(" % too small\n"), std::string::npos) << made.err;
}

TEST_F(ToolsMotion, InJsonItsStepsAreThoseOfItsTable) {
  const std::string steps = "\"to 0,0,1\" \"press 3mm\" \"hold 0.2s\" withdraw";
  const auto as_table = run_program(motion(steps)), as_json = run_program(motion(steps) + " --json");
  ASSERT_EQ(as_json.status, 0) << as_json.err;
  const auto figures = nlohmann::json::parse(as_json.out);
  ASSERT_EQ(figures["steps"].size(), 4u);
  const StepFelt told = felt_in(as_table.out, "hold 0.2s");
  const auto& hold = figures["steps"][2];
  EXPECT_EQ(hold["step"], "hold 0.2s");
  EXPECT_NEAR(hold["to_s"].get<double>(), told.to, 0.006);
  EXPECT_GT(told.largest, 0);
  EXPECT_NEAR(hold["max_force_n"].get<double>(), told.largest, 0.0006);
  EXPECT_NEAR(hold["end_force_n"].get<double>(), told.end, 0.0006);
}

TEST_F(ToolsMotion, IsDrawnWhereThatIsAskedFor) {
  const std::string picture = (scene_.folder() / "made.png").string();
  const auto made = run_program(motion("\"to 0,0,1\" --picture " + picture));
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_NE(made.out.find("made.png: the way of the tip"), std::string::npos) << made.out;
  EXPECT_TRUE(std::filesystem::exists(picture));
}

TEST_F(ToolsMotion, WhatCannotBeDoneIsToldWithItsStep) {
  expect_refusal(motion("\"press 3mm\""), {"press 3mm", "begins with a place"});
  expect_refusal(motion("\"to 0,0,1\" \"press 1e6N\""), {"press 1e6N", "the force is at most"});
  expect_refusal(motion("\"to 0,0,1\" jump"), {"jump", "a step is to"});
  // Before the force of an earlier step is looked for.
  for (const char* deep : {"press 5", "press 1e5"})
    expect_refusal(motion(fmt::format("\"to 0,0,1\" \"press 1e6N\" \"{}\"", deep)),
                   {deep, "a depth of", "0.15 m", "in mm?"});
}

TEST_F(ToolsMotion, WhatNoMotionFileMayHoldIsToldWithItsStep) {
  scene_.replace("[0.0, 0.0, 0.2]", "[0.0, 0.0, 2.5]");
  expect_refusal(motion("\"to 0,0,1\" \"press 3mm\""), {"'to 0,0,1'", "no tool can be there", "the depth 2 m"});
}

TEST_F(ToolsMotion, JawsOpenNoFurtherThanTheyCan) {
  scene_.replace("radius = 0.008", "kind = \"forceps\"");
  scene_.replace("[render]", "[tool.jaws]\nmax_open = 1.0\n[render]");
  expect_refusal(motion("\"to 0,0,1\" \"grip 3\""), {"'grip 3'", "the jaws of this tool open from 0 to"});
}

}  // namespace
}  // namespace palpate
