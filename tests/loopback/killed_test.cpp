// What the hand feels when real nodes are killed while a tool presses moving tissue, by the log.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/bus/log_reader.hpp"
#include "tests/bus/domain.hpp"
#include "tests/loopback/forces_of_runs.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using namespace testing;

constexpr std::uint64_t kUndisturbed = 6000;  // steps: pressed, and aside and back twice
constexpr double kMaxChange = 0.25;           // [N] a step: the default

/// The tip presses a block and goes aside and back every two seconds.
struct PressedScene : LoopbackScene {
  PressedScene() : LoopbackScene("killed", "[body.dynamic]\ndamping = 20\n") {
    replace("quasi_static", "tensor_mass");
    std::string motion = "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n2,0,0,0.197,0,0\n";
    for (int second = 3; second < 120; ++second)
      motion += fmt::format("{},{},0,0.197,0,0\n", second, second % 2 == 0 ? 0.0 : 0.02);
    write("motion.csv", motion);
  }
};

class KilledNodes : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string output;
    ASSERT_EQ(run_command(program("palpate") + " precompute " + scene_.scene(), &output), 0) << output;
  }

  ChildProcess node(const std::string& name) const {
    return {name, {program(name), scene_.scene(), "--domain", std::to_string(own_domain()), "--supervised"}};
  }
  /// Waits for this step of the haptic node that is there, of another one than before.
  bool reaches(std::uint64_t step) { return forces_.reach(step); }
  static void kill_now(ChildProcess& process) {
    kill(process.pid(), SIGKILL);
    EXPECT_TRUE(process.wait(5s));
  }

  PressedScene scene_;
  ForcesOfRuns forces_;
};

/// The forces of a log [N]: the largest until the first death and after it, the last before the haptic node lets it
/// fade at its end, and the largest change in a step.
struct Felt {
  double undisturbed = 0, after = 0, last = 0, change = 0;
};

Felt felt_in(const std::filesystem::path& file) {
  LogReader log(file);
  Felt felt;
  std::uint64_t first_run = 0;
  ForceState before, force;
  for (LogEvent event; log.next(event);) {
    if (!event.read(topics::force_state, force)) continue;
    const double size = std::hypot(force.force[0], force.force[1], force.force[2]);
    if (first_run == 0) first_run = force.run;
    const bool whole = force.run == first_run && force.step < kUndisturbed;
    (whole ? felt.undisturbed : felt.after) = std::max(whole ? felt.undisturbed : felt.after, size);
    if (force.run == before.run && force.step == before.step + 1)
      felt.change = std::max(felt.change, std::hypot(force.force[0] - before.force[0], force.force[1] - before.force[1],
                                                     force.force[2] - before.force[2]));
    if (!(force.flags & silent_device)) felt.last = size;
    before = force;
  }
  return felt;
}

TEST_F(KilledNodes, AreNoKickByTheLog) {
  const std::string file = scene_.folder() / "killed.lcmlog";
  ChildProcess recorder("palpate", {program("palpate"), "record", "--keep", "everything", "-o", file, "--domain",
                                    std::to_string(own_domain())});
  auto deform = std::make_unique<ChildProcess>(node("deform_node"));
  auto haptic = std::make_unique<ChildProcess>(node("haptic_node"));
  ASSERT_TRUE(reaches(kUndisturbed));
  for (const auto away : {50ms, 300ms, 1200ms}) {
    kill_now(*deform);
    std::this_thread::sleep_for(away);
    deform = std::make_unique<ChildProcess>(node("deform_node"));
    std::this_thread::sleep_for(2500ms);
  }
  kill_now(*haptic);
  haptic = std::make_unique<ChildProcess>(node("haptic_node"));
  ASSERT_TRUE(reaches(kUndisturbed - 1000));
  haptic->interrupt();
  EXPECT_TRUE(haptic->wait(10s));
  recorder.interrupt();
  ASSERT_TRUE(recorder.wait(10s));

  const Felt felt = felt_in(file);
  fmt::print("{:.3f} N undisturbed, {:.3f} N after the deaths, {:.3f} N at the end, by {:.3f} N a step\n",
             felt.undisturbed, felt.after, felt.last, felt.change);
  EXPECT_GT(felt.undisturbed, 0.1);
  EXPECT_LT(felt.after, 1.1 * felt.undisturbed);
  EXPECT_GT(felt.last, 0.5 * felt.undisturbed) << "it is felt again";
  EXPECT_LE(felt.change, kMaxChange * (1 + 1e-9));
}

}  // namespace
}  // namespace palpate
