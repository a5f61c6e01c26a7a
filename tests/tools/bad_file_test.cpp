#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/scene/find_archive.hpp"
#include "common/scene/scene.hpp"
#include "tests/bus/domain.hpp"
#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::expect_refusal;
using testing::LoopbackScene;
using testing::program;
using testing::run_program;
using testing::text_of;

const std::string kColumns = "time,yaw,pitch,depth,roll,grip\n";

/// A good scene with its archive, beside which one file is spoiled.
class ToolsBadFile : public ::testing::Test {
 protected:
  static std::string on_own_domain(const std::string& command) {
    return fmt::format("{} --domain {}", command, testing::own_domain());
  }
  void precompute() {
    const auto result = run_program(program("palpate") + " precompute " + scene_.scene());
    ASSERT_EQ(result.status, 0) << result.err;
  }
  std::string haptic_node() const { return on_own_domain(program("haptic_node") + " " + scene_.scene()); }
  std::string file(const std::string& name) const { return scene_.folder() / name; }

  LoopbackScene scene_{"bad-file", testing::kLinear};
};

TEST_F(ToolsBadFile, ATrajectoryThatIsNotOneIsRefusedWithItsLine) {
  precompute();
  const auto refused = [&](const std::string& text, const std::vector<std::string>& fragments) {
    scene_.write("motion.csv", text);
    expect_refusal(haptic_node(), fragments);
    const auto run = run_program(on_own_domain(program("palpate") + " run " + scene_.scene()));
    EXPECT_EQ(run.status, 1) << run.err;
    for (const std::string& fragment : fragments) EXPECT_NE(run.err.find(fragment), std::string::npos) << run.err;
  };
  refused(kColumns + "0,0,0,0.17,0,0\n1,0,nan,0.18,0,0\n", {"motion.csv:3: ", "'nan' is not a finite number"});
  refused(kColumns + "0,0,0,0.17,0,0\n1,0,0\n", {"motion.csv:3: "});
  refused("when,where\n0,0\n", {"motion.csv:1: "});
}

TEST_F(ToolsBadFile, AMissingTrajectoryIsRefusedAtItsPlaceInTheScene) {
  precompute();
  fs::remove(file("motion.csv"));
  for (const char* start : {"palpate check", "palpate run", "haptic_node"})
    expect_refusal(program(start) + " " + scene_.scene(),
                   {"scene.toml:", "motion.csv", "is not a file that can be read"});
}

TEST_F(ToolsBadFile, WhatASceneSaysReachesNoTerminalAsACommand) {
  scene_.replace("title = \"loopback block\"", "title = \"pale\\u001b[8m block\"");
  const auto check = run_program(program("palpate") + " check " + scene_.scene());
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_NE(check.out.find("pale?[8m block"), std::string::npos) << check.out;
  scene_.replace("[render]", "[\"\\u001b]0;owned\\u0007\"]\nx = 1\n[render]");
  for (const char* start : {"palpate check", "haptic_node"}) {
    const auto refused = run_program(program(start) + " " + scene_.scene());
    EXPECT_EQ(refused.status, 1);
    EXPECT_EQ(refused.err.find_first_of("\x1b\x07"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("?]0;owned?"), std::string::npos) << refused.err;
  }
}

TEST_F(ToolsBadFile, AMalformedCurveIsRefusedWithItsLine) {
  const LoopbackScene bent("bad-curve", R"([body.nonlinear]
force_curve = "force.csv"
radial_curve = "radial.csv"
radius = 0.015
height = 0.013
)");
  std::string force = "displacement_m,force_N\n", radial = "displacement_m,radial_m\n";
  for (int i = 0; i <= 12; ++i) {
    const double d = 5e-4 * i;
    force += fmt::format("{},{}\n", d, 400 * d + 1e6 * d * d * d);
    radial += fmt::format("{},{}\n", d, 0.5 * d + 10 * d * d);
  }
  bent.write("force.csv", force);
  bent.write("radial.csv", radial);
  const auto precomputed = run_program(program("palpate") + " precompute " + bent.scene());
  ASSERT_EQ(precomputed.status, 0) << precomputed.err;
  const auto refused = [&](const std::string& name, const std::string& text, const std::string& place) {
    const std::string good = text_of(bent.folder() / name);
    bent.write(name, text);
    expect_refusal(on_own_domain(program("haptic_node") + " " + bent.scene()), {place});
    expect_refusal(program("palpate") + " check " + bent.scene(), {place});
    bent.write(name, good);
  };
  refused("force.csv", testing::replaced(force, "0.001,", "soft,"), "force.csv:4: ");
  refused("radial.csv", testing::replaced(radial, "0.001,", "0.001,1,"), "radial.csv:4: ");
  refused("force.csv", force.substr(0, force.find("0.001,")), "force.csv");
}

TEST_F(ToolsBadFile, ADamagedArchiveIsRefusedAndRebuilt) {
  precompute();
  const Scene scene = load_scene(scene_.scene());
  const fs::path archive = archive_path(scene.bodies[0]);
  const std::string good = text_of(archive), name = archive.filename();
  std::string spoiled = good;
  for (std::size_t i = 0; i < 64; ++i) spoiled[good.size() / 2 + i] ^= 0x55;
  for (const std::string& text : {spoiled, good.substr(0, good.size() / 2), std::string("no archive"), std::string()}) {
    std::ofstream(archive, std::ios::binary) << text;
    expect_refusal(haptic_node(), {name, "palpate precompute"});
  }
  const auto again = run_program(program("palpate") + " precompute " + scene_.scene());
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(run_program(haptic_node() + " --seconds 0.2").status, 0);
  fs::remove(archive);
  expect_refusal(haptic_node(), {"body 'block' has no archive", "palpate precompute"});
}

TEST_F(ToolsBadFile, AFileThatIsNoLogIsRefused) {
  const std::string info = program("palpate") + " info ", replay = on_own_domain(program("palpate") + " replay ");
  scene_.write("empty.lcmlog", "");
  for (const auto& [name, reason] : {std::pair{"motion.csv", "is not a topic log"},
                                     {"empty.lcmlog", "is empty"},
                                     {"none.lcmlog", "cannot be opened"}})
    for (const std::string& command : {info + file(name), info + "--json " + file(name), replay + " " + file(name),
                                       replay + " --verify " + file(name)})
      expect_refusal(command, {std::string(name) + ": ", reason});
}

TEST_F(ToolsBadFile, AToolThatStartsInsideTheOrganIsRefused) {
  precompute();
  scene_.write("motion.csv", kColumns + "0,0,0,0.22,0,0\n5,0,0,0.22,0,0\n");
  const auto node = run_program(haptic_node());
  EXPECT_EQ(node.status, 1);
  for (const char* fragment : {"haptic_node: ", "probe", "inside", "block"})
    EXPECT_NE(node.err.find(fragment), std::string::npos) << node.err;

  const auto run =
      run_program(on_own_domain(program("palpate") + " run " + scene_.scene()) + " --summary " + file("summary.json"));
  EXPECT_EQ(run.status, 1);
  for (const char* fragment : {"haptic_node: ", "inside", "palpate: haptic_node stopped with status 1"})
    EXPECT_NE(run.err.find(fragment), std::string::npos) << run.err;
}

}  // namespace
}  // namespace palpate
