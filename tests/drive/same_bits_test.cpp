#include <gtest/gtest.h>

#include <map>

#include "common/bus/log_reader.hpp"
#include "idl/topics.hpp"
#include "tests/bus/domain.hpp"
#include "tests/tools/program_result.hpp"

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

TEST(DriveSameBits, TheForcesAreThoseOfTheNodesFromTheSameInputs) {
  const LoopbackScene scene("drive-bits", testing::kLinear);
  const std::string recorded = scene.folder() / "nodes.lcmlog", again = scene.folder() / "drive.lcmlog";
  const auto run = run_program(fmt::format("{} run {} --seconds 2.3 --domain {} --record {}", program("palpate"),
                                           scene.scene(), testing::own_domain(), recorded));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto drive = run_program(fmt::format("{} drive {} --set tool.device=log --set tool.trajectory={} --log {}",
                                             program("palpate"), scene.scene(), recorded, again));
  ASSERT_EQ(drive.status, 0) << drive.err;

  const auto nodes = forces_in(recorded), lock_step = forces_in(again);
  ASSERT_GT(nodes.size(), 2000u);
  double largest = 0;
  for (const auto& [step, force] : nodes) {
    const auto same = lock_step.find(step);
    ASSERT_NE(same, lock_step.end()) << step;
    ASSERT_EQ(same->second.force, force.force) << step;
    ASSERT_EQ(same->second.torque, force.torque) << step;
    ASSERT_EQ(same->second.energy, force.energy) << step;
    ASSERT_EQ(same->second.flags, force.flags) << step;
    largest = std::max(largest, std::abs(force.force[2]));
  }
  EXPECT_GT(largest, 0.05);
}

}  // namespace
}  // namespace palpate
