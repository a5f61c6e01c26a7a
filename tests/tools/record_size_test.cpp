// What an hour of recording comes to.
#include <gtest/gtest.h>

#include <utility>

#include "common/bus/log_reader.hpp"
#include "idl/topics.hpp"
#include "tests/bus/domain.hpp"
#include "tests/tools/comes_within.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using namespace testing;

constexpr double kMaxPerHour = 1e9;  // bytes
constexpr double kStepsPerHour = 3600e3;
constexpr std::uint64_t kBegin = 1000;  // steps in which comes what stands in a log once
constexpr double kKeyframe = 10'000;    // steps from one keyframe that is kept to the next

/// What a step of a log comes to [bytes], and how many steps were counted.
struct Kept {
  double per_step = 0;
  std::uint64_t steps = 0;
};

Kept kept_in(const std::filesystem::path& log) {
  LogReader reader(log);
  ToolState tool;
  std::uint64_t begin = 0, end = 0, offset = 0, bytes = 0, keyframe_offset = 0, keyframe = 0;
  for (LogEvent event; reader.next(event);) {
    if (keyframe_offset > 0) keyframe = event.offset - std::exchange(keyframe_offset, 0);
    if (event.channel == topics::haptic_keyframe.name) keyframe_offset = event.offset;
    if (!event.read(topics::tool_state, tool) || tool.step < kBegin) continue;
    if (offset == 0) offset = event.offset, begin = tool.step;
    end = tool.step, bytes = event.offset - offset;
  }
  EXPECT_GT(keyframe, 0u);
  const auto steps = static_cast<double>(end - begin);
  return {static_cast<double>(bytes) / steps + static_cast<double>(keyframe) / kKeyframe, end - begin};
}

TEST(RecordSize, AnHourOfTheLiverByDefaultIsNoMoreThanAGigabyte) {
  const OwnFolder folder("record-size");
  const std::string scene = PALPATE_SOURCE "/scenes/liver.toml", log = folder / "run.lcmlog";
  const std::string domain = std::to_string(own_domain());
  std::string said;
  ASSERT_EQ(run_command(program("palpate") + " precompute " + scene, &said), 0) << said;
  ChildProcess recorder("palpate", {program("palpate"), "record", "-o", log, "--domain", domain});
  const auto run = run_program(fmt::format("{} run {} --processes 3 --domain {} --film {}", program("palpate"), scene,
                                           domain, (folder / "run.mp4").string()));
  EXPECT_EQ(run.status, 0) << run.err;
  recorder.interrupt();
  ASSERT_TRUE(recorder.wait(10s));
  const Kept kept = kept_in(log);
  fmt::print("{:.1f} bytes a step over {} steps, {:.3f} GB an hour\n", kept.per_step, kept.steps,
             1e-9 * kept.per_step * kStepsPerHour);
  EXPECT_GT(kept.steps, 5000u);
  EXPECT_LE(kept.per_step * kStepsPerHour, kMaxPerHour);
}

}  // namespace
}  // namespace palpate
