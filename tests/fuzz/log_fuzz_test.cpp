// Logs whose lengths and checksums are right and whose messages are not: programs read, verify, export and play them,
// or refuse them in words.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/bus/log_reader.hpp"
#include "common/bus/log_writer.hpp"
#include "common/bus/memory_bus.hpp"
#include "common/bus/print.hpp"
#include "common/devices/device.hpp"
#include "common/scene/ensure_archive.hpp"
#include "deform_node/verify_tissue.hpp"
#include "haptic_node/verify.hpp"
#include "idl/topics.hpp"
#include "tests/fuzz/rounds.hpp"
#include "tests/hostile/mutations.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tools/drive/lock_step.hpp"
#include "tools/drive/step_log.hpp"
#include "tools/log_player.hpp"
#include "tools/log_summary.hpp"
#include "tools/logs/log_files.hpp"
#include "tools/mcap/export_mcap.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::any_of;

struct RawLog {
  LogHeader header;
  std::vector<LogEvent> events;
  std::vector<LogFile> files;
};

/// Changes a log in one place.
class LogSpoiler {
 public:
  explicit LogSpoiler(unsigned seed) : random_(seed) {}

  std::string spoil(RawLog& log) {
    const std::size_t at = random_() % log.events.size();
    LogEvent& event = log.events[at];
    switch (random_() % 10) {
      case 0:
        event.receive_ns = any_of(kTimes, random_);
        return fmt::format("event {} at {} ns", at, event.receive_ns);
      case 1:
        std::swap(event, log.events[random_() % log.events.size()]);
        return fmt::format("event {} elsewhere", at);
      case 2:
        log.events.erase(log.events.begin() + static_cast<std::ptrdiff_t>(at));
        return fmt::format("no event {}", at);
      case 3:
        return spoil_header(log);
      case 4:
        return spoil_file(log);
      default:
        return fmt::format("event {}, ", at) + spoil_message(one_of_a_kind(log));
    }
  }

 private:
  static constexpr std::array kTimes{std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max(),
                                     std::int64_t{0}, std::int64_t{-1}, std::int64_t{2'000'000'000'000'000'000}};

  /// Seldom messages are as likely as frequent ones.
  LogEvent& one_of_a_kind(RawLog& log) {
    const LogEvent& any = log.events[random_() % log.events.size()];
    std::string channel = any.channel;
    if (random_() % 2) {
      std::vector<std::string> channels;
      topics::for_each([&](const auto& topic) { channels.push_back(topic.name); });
      channel = any_of(channels, random_);
    }
    std::vector<LogEvent*> of_it;
    for (LogEvent& event : log.events)
      if (event.channel == channel) of_it.push_back(&event);
    return of_it.empty() ? log.events.front() : *any_of(of_it, random_);
  }

  std::string spoil_message(LogEvent& event) {
    if (event.payload.size() > 200 && random_() % 2) return spoil_bytes(event.payload);
    std::string what = "unknown";
    topics::for_each([&]<class M>(const Topic<M>& topic) {
      if (event.channel != topic.name) return;
      M message;
      if (decode(event.payload, message)) what = spoil_field(message, event.payload);
    });
    return what;
  }
  /// One of all that the IDL allows of it.
  template <class M>
  std::string spoil_field(M message, Bytes& payload) {
    int kinds = 0;
    testing::Mutations(message, [&](const std::string&, const M&) { ++kinds; });
    int left = static_cast<int>(random_() % static_cast<unsigned>(kinds));
    std::string what;
    testing::Mutations(message, [&](const std::string& name, const M& spoilt) {
      if (left-- != 0) return;
      what = name;
      payload.clear();
      encode(spoilt, payload);
    });
    return what;
  }
  /// A number in what is only bytes to the reader of a log: states of which keyframes consist.
  std::string spoil_bytes(Bytes& bytes) {
    const std::size_t at = random_() % (bytes.size() / 4 - 1) * 4 + random_() % 4;
    if (at + 8 > bytes.size()) return "nothing";
    const double number = any_of(testing::kExtremeNumbers, random_);
    const std::int32_t whole = any_of(testing::kExtremeIntegers, random_);
    random_() % 2 ? std::memcpy(&bytes[at], &number, 8) : std::memcpy(&bytes[at], &whole, 4);
    return fmt::format("byte {} as {} or {}", at, number, whole);
  }
  std::string spoil_header(RawLog& log) {
    LogHeader& h = log.header;
    if (random_() % 2) return h.start_monotonic_ns = any_of(kTimes, random_), "its start";
    std::string* texts[] = {&h.scene_hash, &h.scene, &h.version, &h.code_path, &h.host};
    *any_of(texts, random_) = std::string(random_() % 3000, '\x1b');
    return "its header";
  }
  std::string spoil_file(RawLog& log) {
    if (log.files.empty()) return "nothing";
    LogFile& file = log.files[random_() % log.files.size()];
    const char* odd[] = {"", "/", "..", "../../etc/passwd", "a/../../b.msh", "x\n.msh", "/proc/self/mem.csv"};
    switch (random_() % 4) {
      case 0:
        return file.path = any_of(odd, random_), "its file's name";
      case 1:
        return file.hash = std::string(random_() % 70, 'f'), "its file's hash";
      case 2:
        return file.size = std::uint64_t{1} << (random_() % 64), "its file's size";
      default:
        return file.content.resize(random_() % (file.content.size() + 1)), "its file's contents";
    }
  }

  std::mt19937 random_;
};

/// A press on moving tissue, beside a body that does not move.
class LogFuzz : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<testing::LoopbackScene>("log-fuzz", "[body.dynamic]\ndamping = 20\n");
    scene_->replace("quasi_static", "tensor_mass");
    scene_->replace(
        "[[tool]]",
        "[[body]]\nname = \"still\"\nmesh = \"block.msh\"\nmodel = \"quasi_static\"\nyoung = 5000\npoisson = "
        "0.4\n[body.offline]\nelement = \"p1\"\n[[body.fixed]]\nbox = [[-1.0, -1.0, -0.0501], [1.0, 1.0, "
        "-0.0499]]\n\n[[tool]]");
    write_tet_mesh(make_block({-0.05, -0.05, -0.05}, {0.05, 0.05, 0}, {4, 4, 2}), scene_->folder() / "block.msh");
    scene_->write("motion.csv",
                  "time,yaw,pitch,depth,roll,grip\n0,0,0,0.18,0,0\n0.2,0,0,0.197,0,0\n0.4,0.06,0.02,0.199,0.3,0\n");
    fs::create_directory(scene_->folder() / "data");
    record();
    LogReader reader(log());
    good_.header = reader.header();
    for (LogEvent event; reader.next(event);) good_.events.push_back(event);
    good_.files = files_for_log(load_scene(scene_->scene()));
  }
  static void TearDownTestSuite() { scene_.reset(); }

  static void record() {
    const Scene scene = load_scene(scene_->scene());
    drive::LockStep lock_step(scene, load_or_precompute(scene, ArchivePart::surface));
    drive::StepLog step_log(log(), lock_step.simulator());
    while (lock_step.time() < 0.4) {
      step_log.before_step();
      lock_step.step();
      step_log.after_step();
    }
    step_log.finish();
  }

  static void write(const RawLog& log, const fs::path& file) {
    LogWriter writer(file, log.header, WhenFull::wait);
    for (const LogEvent& event : log.events) {
      writer.write_payload(event.channel, event.receive_ns, event.payload);
      if (event.channel != topics::scene.name) continue;
      for (const LogFile& with : log.files) writer.write(kFileChannel, event.receive_ns, with);
    }
    ASSERT_EQ(writer.finish().lost, 0u);
  }

  static fs::path log() { return scene_->folder() / "good.lcmlog"; }
  static fs::path spoilt() { return scene_->folder() / "spoilt.lcmlog"; }

  /// True if it went well.
  static bool good(const std::function<void()>& use) {
    try {
      use();
      return true;
    } catch (const std::runtime_error& error) {
      EXPECT_FALSE(std::string(error.what()).empty());
      return false;
    }
  }
  static void print() {
    LogReader reader(spoilt());
    for (LogEvent event; reader.next(event);)
      topics::for_each([&]<class M>(const Topic<M>& topic) {
        if (M message; event.read(topic, message)) to_json(message), csv_row(message);
      });
  }
  static void play() {
    const auto bus = make_memory_bus(make_memory_network());
    PlaySettings settings{.speed = 1e6};
    settings.patience = std::chrono::milliseconds(0);
    play_log(spoilt(), *bus, settings, [](double) { return true; });
  }
  static void move_by_it() {
    const Scene scene = load_scene(scene_->scene());
    LogDeviceSpec spec;
    spec.trajectory = spoilt();
    make_device(spec, DevicePlace{.tool = scene.tools[0], .index = 0, .haptic_hz = scene.rates.haptic_hz})->read(0.5);
  }

  static std::unique_ptr<testing::LoopbackScene> scene_;
  static RawLog good_;
};
std::unique_ptr<testing::LoopbackScene> LogFuzz::scene_;
RawLog LogFuzz::good_;

TEST_F(LogFuzz, WhatWasRecordedIsVerified) {
  const Scene scene = load_scene(scene_->scene());
  write(good_, spoilt());
  EXPECT_TRUE(verify_log(spoilt(), scene).verified());
  EXPECT_EQ(LoggedScene(spoilt(), scene_->folder() / "data").scene().bodies.size(), 2u);
  EXPECT_GT(verify_tissue(spoilt(), scene).ticks, 390u);
}

TEST_F(LogFuzz, IsReadOrRefusedInWords) {
  const Scene scene = load_scene(scene_->scene());
  LogSpoiler spoiler(1);
  std::array<int, 8> went_well{};
  int rounds = 0;
  testing::fuzz(60, 1, [&](int round) {
    RawLog changed = good_;
    std::string what = spoiler.spoil(changed);
    for (int more = round % 4; more > 0; --more) what += "; " + spoiler.spoil(changed);
    SCOPED_TRACE(fmt::format("round {}: {}", round, what));
    scene_->write("what.txt", what);  // lies there where the test does not live to tell
    write(changed, spoilt());
    const std::array<std::function<void()>, 8> uses{[] { summarise_log(spoilt()); },
                                                    print,
                                                    [&] { export_mcap(spoilt(), "", scene_->folder() / "out.mcap"); },
                                                    play,
                                                    move_by_it,
                                                    [&] { verify_log(spoilt(), scene); },
                                                    [&] { verify_tissue(spoilt(), scene); },
                                                    [&] { LoggedScene(spoilt(), scene_->folder() / "data"); }};
    for (std::size_t i = 0; i < uses.size(); ++i) went_well[i] += good(uses[i]);
    ++rounds;
  });
  fmt::print(
      "{} logs; read {}, printed {}, exported {}, played {}, moved by {}, verified {} and {}, found the files {}\n",
      rounds, went_well[0], went_well[1], went_well[2], went_well[3], went_well[4], went_well[5], went_well[6],
      went_well[7]);
  EXPECT_GT(went_well[0], rounds / 2);
}

}  // namespace
}  // namespace palpate
