// What a log proves that was recorded on the host where the haptic node is not.
#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/bus/log_reader.hpp"
#include "common/bus/log_writer.hpp"
#include "common/realtime/clock.hpp"
#include "tests/bus/domain.hpp"
#include "tests/network/network_test.hpp"
#include "tests/network/program_lines.hpp"
#include "tests/realtime/host_watch.hpp"
#include "tests/sanitized.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;
using nlohmann::json;

/// A system over two hosts: haptic node on A, deformation node and recorder on B.
template <class Scene>
class LogOf : public NodesTest<Scene, TwoHosts::Link::veth> {
 protected:
  fs::path log() const { return this->scene_.folder() / "far.lcmlog"; }
  fs::path changed() const { return this->scene_.folder() / "changed.lcmlog"; }

  void record(std::chrono::milliseconds time) {
    ChildProcess deform = this->nodes_->on_b("deform_node");
    ChildProcess recorder = this->nodes_->recorder_on_b("far.lcmlog");
    ASSERT_TRUE(says_ready(recorder));
    std::this_thread::sleep_for(500ms);  // so that they have met
    ChildProcess haptic = this->nodes_->on_a("haptic_node");
    ASSERT_TRUE(this->joined());
    this->observer_->listen(time);
    for (ChildProcess* process : {&haptic, &deform, &recorder}) {
      process->interrupt();
      ASSERT_TRUE(process->wait(10s));
      EXPECT_EQ(process->status(), 0) << process->name();
    }
  }
  /// `palpate replay --verify`: its status, and all that it says in `said`.
  static int verify(const fs::path& file, std::string& said) {
    return run_command(fmt::format("{} replay {} --verify", program("palpate"), file.string()), &said);
  }
  /// The number before some words in what was said; 0 if they are not there.
  static std::uint64_t number_before(const std::string& said, const std::string& words) {
    const std::size_t at = said.find(words);
    if (at == std::string::npos) return 0;
    const std::size_t begin = said.find_last_not_of("0123456789", at - 1) + 1;
    return begin < at ? std::stoull(said.substr(begin, at - begin)) : 0;
  }
  /// Copies the log but for what `drop` picks.
  template <class Drop>
  void copy_without(const Drop& drop) const {
    LogReader reader(log());
    LogWriter writer(changed(), std::size_t{1} << 30);
    writer.write(kHeaderChannel, reader.header().start_monotonic_ns, reader.header());
    for (LogEvent event; reader.next(event);)
      if (!drop(event)) writer.write_payload(event.channel, event.receive_ns, event.payload);
    ASSERT_EQ(writer.finish().lost, 0u);
  }
  /// Forces from the first keyframe on: what can be verified.
  std::uint64_t forces_in_log() const {
    LogReader reader(log());
    ForceState force;
    HapticKeyframe keyframe;
    std::vector<std::uint64_t> steps, keyframes;
    for (LogEvent event; reader.next(event);) {
      if (event.read(topics::force_state, force)) steps.push_back(force.step);
      if (event.read(topics::haptic_keyframe, keyframe)) keyframes.push_back(keyframe.step);
    }
    if (keyframes.empty()) return 0;
    const std::uint64_t first = *std::ranges::min_element(keyframes);
    return static_cast<std::uint64_t>(std::ranges::count_if(steps, [&](std::uint64_t step) { return step >= first; }));
  }
};

/// Receive times of one topic by its sequence number.
std::map<std::uint64_t, std::int64_t> times_of_forces(const fs::path& file) {
  LogReader log(file);
  ForceState force;
  std::map<std::uint64_t, std::int64_t> times;
  for (LogEvent event; log.next(event);)
    if (event.read(topics::force_state, force)) times[force.seq] = event.receive_ns;
  return times;
}

class LogOfQuasiStatic : public LogOf<NetworkScene> {
 protected:
  void expect_proof() const;
  json replayed(const std::string& how, const fs::path& again) const;
  double off_the_even_pace(const fs::path& again) const;
  void expect_replay_at_its_own_pace() const;
  void expect_gap_named() const;
};

void LogOfQuasiStatic::expect_proof() const {
  std::string said;
  EXPECT_EQ(verify(log(), said), 0) << said;
  EXPECT_GT(forces_in_log(), 500u);
  EXPECT_EQ(number_before(said, " forces of"), forces_in_log()) << said;
}

/// What `palpate replay` says of itself while a recorder listens, which writes `again`.
json LogOfQuasiStatic::replayed(const std::string& how, const fs::path& again) const {
  ChildProcess recorder = start("palpate", fmt::format("{} record --supervised --keep everything --domain {} -o {}",
                                                       program("palpate"), own_domain(), again.string()));
  EXPECT_TRUE(says_ready(recorder));
  std::string said;
  EXPECT_EQ(run_command(fmt::format("{} replay {} --domain {} --json {}", program("palpate"), log().string(),
                                    own_domain(), how),
                        &said),
            0)
      << said;
  recorder.interrupt();
  EXPECT_TRUE(recorder.wait(10s));
  return json::parse(said);
}

/// As heard by another process, the distances in time are those of the log: [s] by which half of the forces of a log
/// are off at the most in the log of their replay.
double LogOfQuasiStatic::off_the_even_pace(const fs::path& again) const {
  const auto recorded = times_of_forces(log()), heard = times_of_forces(again);
  EXPECT_EQ(heard.size(), recorded.size());
  std::vector<double> offset, error;
  for (const auto& [seq, time] : heard)
    if (recorded.contains(seq)) offset.push_back(1e-9 * static_cast<double>(time - recorded.at(seq)));
  if (offset.empty()) return std::numeric_limits<double>::infinity();
  std::ranges::sort(offset);
  for (const double o : offset) error.push_back(std::abs(o - at_share(offset, 0.5)));
  std::ranges::sort(error);
  return at_share(error, 0.5);
}

// A host that has other things to do is late for all that it runs: a replay from which it took time is made anew.
void LogOfQuasiStatic::expect_replay_at_its_own_pace() const {
  const auto on_a = std::make_unique<Inside>(hosts_->a());  // where nothing else is, on its loopback
  // All at once takes what the messages cost; those of a step are handed over one after another.
  const json hurried = replayed("--speed 1e6", scene_.folder() / "hurried.lcmlog");
  const double message_us = hurried["pace_us"]["max"].get<double>() / hurried["played"].get<double>();
  const double bound_us = kSanitized ? 1000 : std::max(100.0, 5 * message_us);
  double handed_us = 0, heard_us = 0;
  for (int replay = 0; replay < 3; ++replay) {
    const fs::path again = scene_.folder() / fmt::format("again{}.lcmlog", replay);
    const HostWatch host;
    const double stolen = HostWatch::stolen();
    const std::int64_t begin = now_ns();
    const json report = replayed("", again);
    EXPECT_TRUE(report["complete"].get<bool>());
    EXPECT_EQ(report["skipped"], 0);
    handed_us = report["pace_us"]["p50"].get<double>();
    heard_us = 1e6 * off_the_even_pace(again);
    fmt::print(
        "replay: handed to the bus {:.1f} us (p99 {:.1f} us) after the recorded times, a message costs {:.1f} us; "
        "another process hears it {:.1f} us (median) off the even pace\n",
        handed_us, report["pace_us"]["p99"].get<double>(), message_us, heard_us);
    const bool held_up = HostWatch::stolen() > stolen || host.stood_still(begin, now_ns()) > 0;
    if ((handed_us < bound_us && heard_us < bound_us) || !held_up) break;
  }
  EXPECT_GT(handed_us, 0);
  EXPECT_LT(handed_us, bound_us);
  EXPECT_LT(heard_us, bound_us);
}

void LogOfQuasiStatic::expect_gap_named() const {
  copy_without([](const LogEvent& event) {
    ToolState tool;
    return event.read(topics::tool_state, tool) && tool.step == 1300;
  });
  std::string said;
  EXPECT_EQ(verify(changed(), said), 1);
  const std::string until_next = "cannot verify steps 1300 to 1999: the input of step 1300 is not in the log";
  const std::string until_end = "cannot verify from step 1300: its input is not in the log, and no keyframe follows";
  EXPECT_TRUE(said.find(until_next) != std::string::npos || said.find(until_end) != std::string::npos) << said;
  EXPECT_NE(said.find("not verified as a whole"), std::string::npos) << said;
}

TEST_F(LogOfQuasiStatic, IsVerifiedAndReplayedAtItsOwnPaceAndAGapIsNamed) {
  record(2500ms);
  expect_proof();
  expect_replay_at_its_own_pace();
  expect_gap_named();
}

/// The block in two halves: the middle of it moves and is cut, the rest is quasi-static.
struct HybridScene : CutScene {
  explicit HybridScene(const std::string& name) : CutScene("hybrid-" + name) {
    replace("tensor_mass", "hybrid");
    replace("[body.dynamic]",
            "[[body.hybrid.region]]\nbox = [[-0.03, -0.06, -0.03], [0.03, 0.06, 0.01]]\n[body.dynamic]");
  }
};

template <class Scene>
class LogOfMoving : public LogOf<Scene> {
 protected:
  /// The step's force comes from local contact models of the other host; one that a step used and the log lacks is a
  /// gap.
  void expect_proof() {
    this->record(3500ms);
    std::string said;
    EXPECT_EQ(this->verify(this->log(), said), 0) << said;
    EXPECT_EQ(this->number_before(said, " forces of"), this->forces_in_log()) << said;
    EXPECT_GT(this->number_before(said, " ticks of the tissue"), 300u) << said;

    ToolState used;
    LogReader log(this->log());
    ToolState tool;
    std::uint64_t models = 0;
    for (LogEvent event; log.next(event);)
      if (event.read(topics::tool_state, tool) && tool.local_model_seq > used.local_model_seq) {
        ++models;
        if (tool.step <= 2500) used = tool;
      }
    EXPECT_GT(models, 100u) << "the haptic node had models from the other host";
    ASSERT_GT(used.local_model_seq, 0u);
    this->copy_without([&](const LogEvent& event) {
      LocalContactModel model;
      return event.read(topics::local_contact_model, model) && model.run == used.local_model_run &&
             model.seq == used.local_model_seq;
    });
    EXPECT_EQ(this->verify(this->changed(), said), 1) << said;
    EXPECT_NE(said.find(fmt::format("the local contact model {} of tool 0 of step {} is not in the log",
                                    used.local_model_seq, used.step)),
              std::string::npos)
        << said;
    EXPECT_NE(said.find("cannot verify"), std::string::npos) << said;
  }
};

using LogOfDynamic = LogOfMoving<CutScene>;
TEST_F(LogOfDynamic, IsVerifiedOnceItsModelsAreThere) {
  expect_proof();
}

using LogOfHybrid = LogOfMoving<HybridScene>;
TEST_F(LogOfHybrid, IsVerifiedOnceItsModelsAreThere) {
  expect_proof();
}

}  // namespace
}  // namespace palpate::testing
