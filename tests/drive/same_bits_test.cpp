#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "common/bus/dds_bus.hpp"
#include "common/bus/log_reader.hpp"
#include "common/realtime/clock.hpp"
#include "idl/topics.hpp"
#include "tests/bus/domain.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using testing::LoopbackScene;
using testing::program;
using testing::run_program;

std::map<std::uint64_t, ForceState> forces_in(const std::filesystem::path& file) {
  std::map<std::uint64_t, ForceState> forces;
  LogReader log(file);
  ForceState force;
  for (LogEvent event; log.next(event);)
    if (event.read(topics::force_state, force)) forces[force.step] = force;
  return forces;
}

/// A log's forces are those of lock step from its motion, bit for bit; the largest along z [N].
double expect_same_bits(const std::map<std::uint64_t, ForceState>& nodes,
                        const std::map<std::uint64_t, ForceState>& lock_step) {
  double largest = 0;
  for (const auto& [step, force] : nodes) {
    const auto same = lock_step.find(step);
    EXPECT_NE(same, lock_step.end()) << step;
    if (same == lock_step.end()) break;
    EXPECT_EQ(same->second.force, force.force) << step;
    EXPECT_EQ(same->second.torque, force.torque) << step;
    EXPECT_EQ(same->second.energy, force.energy) << step;
    EXPECT_EQ(same->second.flags, force.flags) << step;
    if (::testing::Test::HasFailure()) break;
    largest = std::max(largest, std::abs(force.force[2]));
  }
  return largest;
}

/// Runs a scene's nodes for what they recorded of it. A recorder that was kept from running while the haptic node
/// looked for its peers lacks the first steps, without which the others do not come again: then it is run again, twice
/// at most.
std::map<std::uint64_t, ForceState> record_from_the_first_step(const std::string& scene, const std::string& log) {
  std::map<std::uint64_t, ForceState> forces;
  for (int i = 0; i < 3 && !forces.contains(0); ++i) {
    const auto run = run_program(fmt::format("{} run {} --seconds 2.3 --domain {} --record {}", program("palpate"),
                                             scene, testing::own_domain(), log));
    EXPECT_EQ(run.status, 0) << run.err;
    forces = forces_in(log);
  }
  return forces;
}

/// Runs a scene's nodes, and lock step from what they recorded.
void expect_lock_step_repeats(const std::string& scene, const std::filesystem::path& folder) {
  const std::string recorded = folder / "nodes.lcmlog", again = folder / "drive.lcmlog";
  const auto nodes = record_from_the_first_step(scene, recorded);
  ASSERT_GT(nodes.size(), 2000u);
  ASSERT_EQ(nodes.begin()->first, 0u);
  const auto drive = run_program(fmt::format("{} drive {} --set tool.device=log --set tool.trajectory={} --log {}",
                                             program("palpate"), scene, recorded, again));
  ASSERT_EQ(drive.status, 0) << drive.err;

  EXPECT_GT(expect_same_bits(nodes, forces_in(again)), 0.05);
}

TEST(DriveSameBits, TheForcesAreThoseOfTheNodesFromTheSameInputs) {
  const LoopbackScene scene("drive-bits", testing::kLinear);
  expect_lock_step_repeats(scene.scene(), scene.folder());
}

TEST(DriveSameBits, TheForcesOfTheLiverAreThoseOfTheNodesFromTheSameInputs) {
  const testing::OwnFolder folder("drive-bits-liver");
  expect_lock_step_repeats(PALPATE_SOURCE "/scenes/liver.toml", folder.path());
}

// As a page does it: some sixty poses a second until the person lets go.
TEST(DriveSameBits, ASessionByPointerIsAMotionThatLockStepRepeats) {
  const LoopbackScene scene("drive-pointer", testing::kLinear);
  scene.replace("device = \"scripted\"\ntrajectory = \"motion.csv\"", "device = \"pointer\"\nstart = [0, 0, 0.02]");
  const std::string recorded = scene.folder() / "session.lcmlog", again = scene.folder() / "drive.lcmlog";
  ASSERT_EQ(run_program(program("palpate") + " precompute " + scene.scene()).status, 0);
  ChildProcess run("palpate", {program("palpate"), "run", scene.scene(), "--seconds", "3", "--keep", "everything",
                               "--domain", std::to_string(testing::own_domain()), "--record", recorded});
  const auto bus = make_dds_bus({.domain = testing::own_domain()});
  const auto device = bus->writer(topics::device_state);
  DeviceState pose;
  for (std::int64_t begin = 0; run.running(); sleep_until_ns(now_ns() + kNsPerS / 60)) {
    if (device->readers() == 0) continue;
    if (begin == 0) begin = now_ns();
    const double seconds = 1e-9 * static_cast<double>(now_ns() - begin);
    if (seconds > 2) continue;
    pose.depth = 0.18 + 0.018 * std::sin(std::min(seconds, 1.0) * std::numbers::pi / 2);
    pose.yaw = 0.05 * seconds;
    pose.seq++;
    pose.sense_ns = now_ns();
    pose.publish_ns = 0;
    device->write(pose);
  }
  ASSERT_EQ(run.status(), 0);
  const auto drive = run_program(fmt::format("{} drive {} --set tool.device=log --set tool.trajectory={} --log {}",
                                             program("palpate"), scene.scene(), recorded, again));
  ASSERT_EQ(drive.status, 0) << drive.err;
  EXPECT_GT(expect_same_bits(forces_in(recorded), forces_in(again)), 0.05);
}

}  // namespace
}  // namespace palpate
