// What the hands feel in an example that real nodes play, by the log: as often as it is played what lock step gives,
// and when its deformation node is killed, or stands still, in the midst of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <random>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/bus/log_reader.hpp"
#include "tests/bus/domain.hpp"
#include "tests/fuzz/rounds.hpp"
#include "tests/loopback/forces_of_runs.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tests/realtime/resident.hpp"
#include "tests/realtime/speed_watch.hpp"
#include "tests/sanitized.hpp"
#include "tests/tools/comes_within.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using namespace testing;

constexpr double kMaxStepChange = 0.25;  // [N] a step: the default
constexpr int kTools = 2;
// [steps] in which it comes back and its tissue is felt again, and some: then the script goes on as if what was not cut
// meanwhile were, and is pushed back as hard as it presses.
constexpr int kAfter = 2500;
constexpr int kFirst = 1500, kLast = 13000;  // steps between which it dies
constexpr int kFirstStop = 800;              // step: the scalpel comes down on the plate
constexpr int kStops = 6;                    // in a run of ten seconds
constexpr auto kStop = 400ms;
// [N] The largest force of runs on time: 0.05 to 0.12 measured, 0.056 in lock step.
constexpr double kLeftAlone = 0.12;
// [N] in any run, and in a step. What tissue that stood for a quarter of the time still holds of what lock step has
// cut, and how far it has sunk, is another matter in each: up to 0.23 N, by 0.05 N, in 60 runs; with a kick 8.6 N.
constexpr double kMostOfStopped = 0.3, kMostChangeOfStopped = 0.1;
constexpr int kCarried = 12800;  // step: what was cut is carried away
constexpr int kHapticStops = 12;
constexpr std::array kHapticStop{5ms, 20ms};  // by turns
constexpr auto kBetween = 100ms;
constexpr auto kToEnd = std::numeric_limits<std::uint64_t>::max();
// Of the largest force of forceps and scalpel, by which a run in real time may be off lock step where its tissue has
// lost kLittle or less; twice that at kLate, in proportion between. Measured: the forceps' within 0.2 %; the scalpel's
// 1.4 % more where the tissue lost 0.002 to 0.008 s in all, 4.5 % where it lost 0.07 s, up to 6 % at 0.09 s, 11 % at
// 0.15 s; later than kLate up to 2 % more, and half as much once in seven runs.
constexpr std::array kAlike{0.05, 0.1};
constexpr double kLittle = 0.1, kLate = 0.2;  // [s] that the tissue may lose in such a run
// Of what the machine's cores lose of their computing, by which the tissue may be late: 0.12 to 0.33 measured, where a
// host clocked them at a twelfth for 7 to 30 ms at a time, and they lost 0.5 to 1.9 s of 16.
constexpr double kLateOfLost = 0.5;
constexpr std::uint64_t kInAir = 500;  // step: the scalpel comes down
constexpr auto kUntilTouched = 3s;     // after it, tissue is touched and what is near the tools has been solved for
constexpr double kMapped = 32;         // [MB] that may come to be resident meanwhile; what is mapped holds up the loop

/// The largest force of each tool until a step, the largest of all, and the largest change of one in a step [N].
struct FeltByTools {
  std::array<double, kTools> force{};
  double later = 0, change = 0;
  double late = 0;  ///< [s] the tissue at most, by the reckoning of each deformation node that was there
  double lost = 0;  ///< [s] of computing that this machine's cores lost meanwhile
  std::uint64_t steps = 0;
};

FeltByTools felt_by_tools_in(const std::filesystem::path& file, std::uint64_t until) {
  LogReader log(file);
  FeltByTools felt;
  std::array<ForceState, kTools> last;
  ForceState now;
  DeformStep tick;
  for (LogEvent event; log.next(event);) {
    if (event.read(topics::deform_step, tick))
      felt.late = std::max(felt.late, 1e-9 * static_cast<double>(tick.late_ns));
    if (!event.read(topics::force_state, now)) continue;
    ForceState& before = last.at(now.tool);
    double& largest = now.step < until ? felt.force[now.tool] : felt.later;
    largest = std::max(largest, std::hypot(now.force[0], now.force[1], now.force[2]));
    if (now.step == before.step + 1)
      felt.change = std::max(felt.change, std::hypot(now.force[0] - before.force[0], now.force[1] - before.force[1],
                                                     now.force[2] - before.force[2]));
    before = now;
    felt.steps = std::max(felt.steps, now.step);
  }
  return felt;
}

/// A share by which a run in real time may be off lock step, for how late its tissue was.
double alike(double share, const FeltByTools& felt) {
  return share * std::clamp(felt.late / kLittle, 1., kLate / kLittle);
}

class InAnExample : public ::testing::Test {
 protected:
  explicit InAnExample(const std::string& name) : scene_(PALPATE_SOURCE "/scenes/" + name + ".toml") {}
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    std::string output;
    ASSERT_EQ(run_command(program("palpate") + " precompute " + scene_, &output), 0) << output;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  FeltByTools in_lock_step(std::uint64_t until = kToEnd) const {
    const std::string file = folder_ / "lock_step.lcmlog";
    std::string said;
    EXPECT_EQ(run_command(program("palpate") + " drive " + scene_ + " --log " + file, &said), 0) << said;
    return felt_by_tools_in(file, until);
  }
  /// Runs the example in real time, from when the deformation node has loaded it; `meanwhile` is called once the haptic
  /// node is there, with the deformation node and with it.
  template <class Meanwhile>
  FeltByTools run(Meanwhile&& meanwhile, std::uint64_t until = kToEnd) {
    const std::string file = folder_ / "run.lcmlog";
    const SpeedWatch speed;
    ChildProcess recorder("palpate", {program("palpate"), "record", "--keep", "everything", "--force", "-o", file,
                                      "--domain", std::to_string(own_domain())});
    auto deform = std::make_unique<ChildProcess>(node("deform_node"));
    EXPECT_TRUE(comes_within(30s, [&] { return !deform->take_lines().empty(); })) << "it is ready";
    ChildProcess haptic = node("haptic_node");
    meanwhile(deform, haptic);
    EXPECT_TRUE(haptic.wait(60s)) << "its script ends";
    recorder.interrupt();
    EXPECT_TRUE(recorder.wait(10s));
    const double lost = speed.lost();
    FeltByTools felt = felt_by_tools_in(file, until);
    felt.lost = lost;
    return felt;
  }
  /// The same, where the tissue fell behind the least late of three runs.
  template <class Meanwhile>
  FeltByTools least_late_run(Meanwhile&& meanwhile, std::uint64_t until = kToEnd) {
    FeltByTools felt = run(meanwhile, until);
    for (int again = 0; again < 2 && felt.late > kLittle; ++again)
      felt = std::min(felt, run(meanwhile, until), [](auto& a, auto& b) { return a.late < b.late; });
    return felt;
  }
  ChildProcess node(const std::string& name) const {
    return {name, {program(name), scene_, "--domain", std::to_string(own_domain()), "--supervised"}};
  }
  bool reaches(std::uint64_t step) { return forces_.reach(step); }

 private:
  std::string scene_;
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("palpate-killed-in-example-{}", getpid());
  ForcesOfRuns forces_;
};

class KilledInAnExample : public InAnExample {
 protected:
  KilledInAnExample() : InAnExample("hepatectomy") {}
  const FeltByTools& undisturbed() {
    static const FeltByTools felt = in_lock_step();  // for all cases
    return felt;
  }
};

class LeftAloneInAnExample : public KilledInAnExample {};

class StoppedInAnExample : public InAnExample {
 protected:
  StoppedInAnExample() : InAnExample("plate_cut") {}
};

TEST_F(KilledInAnExample, WithoutThatATouchMapsNothingLarge) {
  const std::unique_ptr<Bus> bus = make_dds_bus({.domain = own_domain()});
  const auto ticks = bus->reader(topics::deform_step);
  double grown = 0;
  run([&](const std::unique_ptr<ChildProcess>& deform, auto&) {
    ASSERT_TRUE(comes_within(30s, [&] { return ticks->take().has_value(); })) << "its heap is there";
    ASSERT_TRUE(reaches(kInAir));
    const double before = resident_mb(deform->pid());
    std::this_thread::sleep_for(kUntilTouched);
    grown = resident_mb(deform->pid()) - before;
  });
  fmt::print("{:.1f} MB more\n", grown);
  EXPECT_TRUE(grown < kMapped || kSanitized);
}

// In the suite it runs alone: beside others its tissue is late.
TEST_F(LeftAloneInAnExample, ItIsFeltAsInLockStepEachTime) {
  if (testing::kSanitized) GTEST_SKIP() << "a sanitizer's tissue is slower than its ticks: MissedTicks.* are of that";
  for (int time = 0; time < (std::getenv("PALPATE_LONG_TESTS") ? 5 : 1); ++time) {
    const FeltByTools felt = least_late_run([](auto&, auto&) {});
    EXPECT_LT(felt.late, kLittle + kLateOfLost * felt.lost) << "[s] it is the program that makes the tissue late";
    EXPECT_GT(felt.steps, static_cast<std::uint64_t>(kLast)) << time;
    for (int tool = 0; tool < kTools; ++tool) {
      fmt::print("tool {}: {:.4f} N in lock step, {:.4f} N with tissue {:.3f} s late; cores lost {:.2f} s\n", tool,
                 undisturbed().force[tool], felt.force[tool], felt.late, felt.lost);
      const double off = alike(kAlike[tool], felt) * undisturbed().force[tool];
      EXPECT_LE(felt.force[tool], undisturbed().force[tool] + off) << time;
      // Later than that, less may be felt of it.
      if (felt.late <= kLate) {
        EXPECT_GE(felt.force[tool], undisturbed().force[tool] - off) << time;
      }
    }
  }
}

TEST_F(KilledInAnExample, ADeformationNodeThatComesBackIsNoKickByTheLog) {
  if (testing::kSanitized) GTEST_SKIP() << "a sanitizer's tissue is slower than its ticks: MissedTicks.* are of that";
  ASSERT_GT(undisturbed().steps, static_cast<std::uint64_t>(kLast));
  repeat(1, 25min, [&](int round) {
    std::mt19937 random(round);
    const std::uint64_t step = std::uniform_int_distribution<>(kFirst, kLast)(random);
    const auto away = std::chrono::milliseconds(std::uniform_int_distribution<>(10, 2000)(random));
    const FeltByTools felt = least_late_run(
        [&](std::unique_ptr<ChildProcess>& deform, auto&) {
          ASSERT_TRUE(reaches(step));
          kill(deform->pid(), SIGKILL);
          EXPECT_TRUE(deform->wait(5s));
          std::this_thread::sleep_for(away);
          deform = std::make_unique<ChildProcess>(node("deform_node"));
        },
        step + away.count() + kAfter);
    EXPECT_GT(felt.steps, step) << round;
    EXPECT_LE(felt.change, kMaxStepChange * (1 + 1e-9)) << round;
    for (int tool = 0; tool < kTools; ++tool) {
      fmt::print(
          "round {}, at step {}, away {} ms, tool {}: {:.3f} N undisturbed, {:.3f} N with tissue {:.3f} s late, {:.3f} "
          "N later, by {:.3f} N a step\n",
          round, step, away.count(), tool, undisturbed().force[tool], felt.force[tool], felt.late, felt.later,
          felt.change);
      EXPECT_LE(felt.force[tool], (1 + alike(0.1, felt)) * undisturbed().force[tool]) << round;
    }
  });
}

// As a host may that has other work for the core: the tissue goes on meanwhile, and so does the hand.
TEST_F(KilledInAnExample, AHapticNodeThatStandsForAMomentIsNoKick) {
  if (testing::kSanitized) GTEST_SKIP() << "a sanitizer's tissue is slower than its ticks: TissueTool.* are of that";
  const FeltByTools in_step = in_lock_step(kCarried);
  const FeltByTools felt = run(
      [&](auto&, const ChildProcess& haptic) {
        ASSERT_TRUE(reaches(kCarried));
        for (int i = 0; i < kHapticStops; ++i) {
          kill(haptic.pid(), SIGSTOP);
          std::this_thread::sleep_for(kHapticStop[i % 2]);
          kill(haptic.pid(), SIGCONT);
          std::this_thread::sleep_for(kBetween);
        }
      },
      kCarried);
  fmt::print("{:.3f} N, by {:.3f} N a step; in lock step {:.3f} N, by {:.3f} N\n", felt.later, felt.change,
             in_step.later, in_step.change);
  EXPECT_GT(in_step.later, 0.05);
  EXPECT_LE(felt.later, 2 * in_step.later);
}

TEST_F(StoppedInAnExample, ADeformationNodeThatStandsStillIsNoKickByTheLog) {
  // A sanitizer's tissue falls behind in both.
  const FeltByTools undisturbed = kSanitized ? run([](auto&, auto&) {}) : in_lock_step();
  repeat(1, 10min, [&](int round) {
    std::mt19937 random(round);
    const auto stopped = [&] {
      const FeltByTools felt = run([&](const std::unique_ptr<ChildProcess>& deform, auto&) {
        ASSERT_TRUE(reaches(kFirstStop + random() % 1000));
        for (int i = 0; i < kStops; ++i) {
          kill(deform->pid(), SIGSTOP);
          std::this_thread::sleep_for(kStop);
          kill(deform->pid(), SIGCONT);
          std::this_thread::sleep_for(std::chrono::milliseconds(500 + random() % 700));
        }
      });
      fmt::print("round {}: {:.3f} N undisturbed, by {:.3f} N a step; {:.3f} N, by {:.3f} N a step\n", round,
                 undisturbed.force[0], undisturbed.change, felt.force[0], felt.change);
      EXPECT_GT(felt.force[0], 0.01) << round;
      EXPECT_LE(felt.force[0], kMostOfStopped) << round;
      EXPECT_LE(felt.change, kMostChangeOfStopped) << round;
      EXPECT_GT(felt.steps, static_cast<std::uint64_t>(kFirstStop + kStops * 1000)) << round;
      return felt.force[0];
    };
    EXPECT_GT(undisturbed.force[0], 0.04) << round;
    const double bound = 1.1 * std::max(kLeftAlone, undisturbed.force[0]);
    double least = stopped();
    for (int again = 0; again < 2 && least > bound; ++again) least = std::min(least, stopped());
    EXPECT_LE(least, bound) << round;
  });
}

}  // namespace
}  // namespace palpate
