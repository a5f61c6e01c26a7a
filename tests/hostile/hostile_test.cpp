// A participant of the test's own attacks running nodes in the names of the real ones.
#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "common/realtime/clock.hpp"
#include "common/realtime/settings.hpp"
#include "tests/fuzz/rounds.hpp"
#include "tests/hostile/attacked_system.hpp"
#include "tests/hostile/learned.hpp"
#include "tests/hostile/mutations.hpp"
#include "tests/hostile/random_mutation.hpp"
#include "tests/sanitized.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

constexpr double kMaxForce = 10, kMaxRise = 0.25;  // [N], [N] a step: the scene's defaults
constexpr double kMaxShare = 0.1;                  // of the undisturbed force, by which it may be off
constexpr double kMaxInFreeAir = 1;                // [N] more than this tissue's weight and 0.2 mm of its stiffness
constexpr double kFlatMb = 64;                     // by which a node may grow in all, its warm-up included
constexpr double kFlood = 10;                      // [MB] by which it may in a flood of names
// The loop runs at 1000 Hz while the machine does: much may fall out in one attack of a second or two, little in all.
constexpr double kMinHz = 950, kMinHzOfAll = 990;

constexpr std::chrono::seconds kAfterFlood{15};  // in which pictures come again: on a busy machine they yield first
constexpr std::chrono::minutes kLong{25};        // each with PALPATE_LONG_TESTS; the other cases take some minutes then

bool long_form() {
  return std::getenv("PALPATE_LONG_TESTS") != nullptr;
}

/// One system for all attacks, since each starts from what the ones before have left; open to all, or with keys, which
/// the attacker has too.
class Hostile : public ::testing::TestWithParam<bool> {
 protected:
  static void SetUpTestSuite() {
    const std::string suite = ::testing::UnitTest::GetInstance()->current_test_suite()->name();
    host_ = std::make_unique<HostWatch>();
    system_ = std::make_unique<AttackedSystem>(own_domain(), suite.starts_with("WithKeys/"));
    memory_ = system_->memory_mb();
    system_->watch(1s);  // what they take when they begin
  }
  static void TearDownTestSuite() {
    system_.reset();
    host_.reset();
  }

  void SetUp() override {
    if (!is_in_free_air()) system().press();
    system().begin_anew();
  }
  static bool is_in_free_air() {
    return std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()).find("InFreeAir") !=
           std::string::npos;
  }
  void TearDown() override {
    if (ended_) return;
    system_->watch(20ms);
    EXPECT_TRUE(system_->all_run());
    for (int tool = 0; tool < hand().tools(); ++tool) expect_guarded(tool);
    const double rate_hz = hand().rate_hz(*host_);
    EXPECT_GE(rate_hz, kMinHz);
    const double in_all = grown_since(memory_);
    EXPECT_TRUE(in_all < kFlatMb || testing::kSanitized) << in_all << " MB";
    fmt::print("{:.0f} Hz; memory: {:.1f} MB more\n", rate_hz, in_all);
    if (misled_) system_->press_again();
    EXPECT_TRUE(is_in_free_air() || system_->is_undisturbed(20s)) << "what was done lasts";
  }
  /// A hand that rests is given what it was, or, while tissue or driver is silent, less.
  void expect_guarded(int tool) const {
    const FeltForce& felt = hand().of(tool);
    const double undisturbed = felt.undisturbed().norm();
    fmt::print("tool {}: {:.3f} N, {:.3f} N at most, {:.3f} N off, by {:.3f} N a step\n", tool, undisturbed,
               felt.max_force(), felt.max_off(), felt.max_change());
    EXPECT_TRUE(felt.finite()) << tool;
    EXPECT_LE(felt.max_force(), kMaxForce * (1 + 1e-9)) << tool;
    EXPECT_LE(felt.max_rise(), kMaxRise + 1e-9) << tool;
    // All tools have one account of energy: where one is thrown about and overdraws it, the others' forces fall too.
    if (misled_ && tool != kHovering) return;
    EXPECT_LE(felt.max_change(), kMaxRise + 1e-9) << tool;
    if (lied_to_) return;
    if (tool == kHovering || is_in_free_air()) {
      EXPECT_LT(felt.max_force(), kMaxInFreeAir);
    } else {
      EXPECT_GT(undisturbed, 4 * kMaxRise) << tool << " does not press";
      EXPECT_LE(felt.max_off(), kMaxShare * undisturbed + kMaxRise) << tool;
    }
  }

  using Memory = std::map<std::string, double>;
  /// [MB] by which the node that grew most has grown.
  static double grown_since(const Memory& before) {
    double grown = 0;
    for (const auto& [name, mb] : system_->memory_mb()) grown = std::max(grown, mb - before.at(name));
    return grown;
  }
  /// [MB] by which the node grows that grows most in a flood, send(k) for each k, behind a first one a third as long:
  /// what the allocator takes once for all floods is not what a name costs.
  template <class Send>
  double grown_in_flood(int many, Send&& send) const {
    const auto flood = [&](int from, int to) {
      for (int k = from; k < to; ++k) {
        send(k);
        if (k % 300 == 0) system().watch(1ms);
      }
      system().watch(100ms);
    };
    flood(0, many / 3);
    const Memory before = system().memory_mb();
    flood(many / 3, many / 3 + many);
    return testing::kSanitized ? 0 : grown_since(before);
  }

  static AttackedSystem& system() { return *system_; }
  static HandWatch& hand() { return system_->hand(); }
  template <class M>
  static std::unique_ptr<HostileWriter<M>> writer(const Topic<M>& topic) {
    std::unique_ptr<HostileWriter<M>> made(new HostileWriter<M>(system_->attacker().writer(topic)));
    system_->watch(150ms);  // the nodes find it
    return made;
  }
  static std::uint64_t haptic_run() { return hand().newest().run; }
  static std::uint64_t deform_run() { return system_->run_of("deform"); }

  /// Of the loop since it began, [Hz], from what it says at its end.
  static double rate_hz(const nlohmann::json& said) {
    const double seconds = said.value("seconds", 0.0);
    const std::int64_t end = now_ns();
    return host_->rate_hz(said.value("rate_hz", 0.0) * seconds, end - static_cast<std::int64_t>(1e9 * seconds), end);
  }

  bool ended_ = false;
  bool lied_to_ = false;  ///< somebody tells of tissue in the deform node's name
  bool misled_ = false;   ///< somebody moves the driven tool in its driver's name

  static bool says(const std::string& node, const std::string& words) {
    return system_->said(node).find(words) != std::string::npos;
  }

 private:
  static std::unique_ptr<HostWatch> host_;
  static std::unique_ptr<AttackedSystem> system_;
  static Memory memory_;
};
std::unique_ptr<HostWatch> Hostile::host_;
std::unique_ptr<AttackedSystem> Hostile::system_;
Hostile::Memory Hostile::memory_;

using AllTopics = decltype(topics::all);

/// Calls f(i) with the place of each topic as a constant, but for that of drivers, in whose name a tool can be moved.
template <class F>
void for_each_topic_of_nodes(F&& f) {
  const auto of = [&]<std::size_t i>(std::integral_constant<std::size_t, i> at) {
    using Message = typename std::tuple_element_t<i, AllTopics>::Message;
    if constexpr (!std::same_as<Message, DeviceState>) f(at);
  };
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (of(std::integral_constant<std::size_t, i>{}), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<AllTopics>>{});
}

/// A press of 10 N on the hovering tool, as the deform node would tell of it.
LocalContactModel press(std::uint64_t tool_run, std::uint64_t deform_run, std::uint64_t step, std::uint64_t seq) {
  LocalContactModel m{.tool = kHovering, .run = deform_run, .seq = seq, .tool_run = tool_run, .tool_step = step};
  m.depth = 0.186;
  m.contacts.push_back({0, 0, {0, 0, 0.006}, {0, 0, -1}, {0, 0, -10}, {}});
  return m;
}

TEST_P(Hostile, ATissueThatPressesAToolInFreeAirIsNotFelt) {
  const auto models = writer(topics::local_contact_model);
  system().pause("deform");  // whose own models would come between
  for (std::uint64_t k = 0; k < 200; ++k) {
    models->write(press(haptic_run(), deform_run(), hand().newest().step - 2, 1'000'000 + k));
    system().watch(1ms);
  }
  system().go_on("deform");
  EXPECT_TRUE(system().watch(3s, [] { return says("haptic", "local contact model"); })) << "it says so";
}

TEST_P(Hostile, EveryFieldAtItsExtremes) {
  Learned learned(system().attacker().bus(), topics::all);
  system().watch(400ms);
  learned.take();
  int kinds = 0, sent = 0;
  for_each_topic_of_nodes([&](auto at) {
    const auto& topic = std::get<at>(topics::all);
    const auto attack = system().attacker().writer(topic);
    system().watch(50ms);
    auto base = learned.template of<at>((topic.writers & roles::deform) ? deform_run() : haptic_run());
    if constexpr (requires { base.tool_run; })
      base.tool = kHovering, base.contacts = press(haptic_run(), deform_run(), 0, 1).contacts;
    Mutations(base, [&](const std::string&, const auto& message) {
      ++kinds;
      sent += attack.write(message);
      if (kinds % 4 == 0) system().watch(1ms);
    });
  });
  fmt::print("{} kinds, {} of them sent\n", kinds, sent);
  EXPECT_GE(sent, 200);
  EXPECT_TRUE(
      system().watch(3s, [] { return says("render", "messages are refused") || says("web", "messages are refused"); }));
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

// Each round in other fields, by its number; short ones the same in each run, long ones until the time is over. Models
// of tissue have a case of their own: in their sender's name tissue can be made stiffer.
TEST_P(Hostile, AnyFieldsSpoiltByChance) {
  Learned learned(system().attacker().bus(), topics::all);
  const auto writers = std::apply(
      []<class... M>(const Topic<M>&... topic) {
        return std::tuple{
            std::unique_ptr<HostileWriter<M>>(new HostileWriter<M>(system().attacker().writer(topic)))...};
      },
      topics::all);
  system().watch(400ms);
  int sent = 0;
  repeat(40, kLong, [&](int round) {
    std::mt19937_64 random(round);
    for_each_topic_of_nodes([&](auto at) {
      learned.take();
      auto message =
          learned.template of<at>((std::get<at>(topics::all).writers & roles::deform) ? deform_run() : haptic_run());
      if constexpr (!std::same_as<decltype(message), LocalContactModel>) {
        RandomMutation(random).spoil(message);
        sent += std::get<at>(writers)->write(message);
        system().watch(1ms);
      }
    });
    if (!HasFailure() && !system().all_run()) ADD_FAILURE() << "a node is gone after round " << round;
  });
  fmt::print("{} sent\n", sent);
  EXPECT_GE(sent, 300);
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, ATissueThatLiesIsBoundedAndDoesNotLast) {
  lied_to_ = true;
  const auto models = writer(topics::local_contact_model);
  Learned learned(system().attacker().bus(), std::tuple{topics::local_contact_model});
  system().watch(200ms);
  repeat(300, 5min, [&](int round) {
    std::mt19937_64 random(round);
    learned.take();
    LocalContactModel model = learned.of<0>(deform_run());
    RandomMutation(random).spoil(model);
    models->write(model);
    system().watch(1ms);
  });
}

TEST_P(Hostile, ADriverThatLiesMovesItsToolAndNoMore) {
  misled_ = true;
  const auto driver = writer(topics::device_state);
  DeviceState state{.tool = kDriven, .seq = 1, .depth = kPressed};
  Mutations(state, [&](const std::string&, const DeviceState& message) {
    driver->write(message);
    system().watch(1ms);
  });
  for (int round = 0; round < 300; ++round) {
    std::mt19937_64 random(round);
    DeviceState spoilt = state;
    RandomMutation(random).spoil(spoilt);
    driver->write(spoilt);
    system().watch(1ms);
  }
}

TEST_P(Hostile, InstancesThatOthersSayAreOverGoOn) {
  Learned learned(system().attacker().bus(), topics::all);
  system().watch(400ms);
  learned.take();
  for_each_topic_of_nodes([&](auto at) {
    const auto& topic = std::get<at>(topics::all);
    const auto attack = system().attacker().writer(topic);
    system().watch(50ms);
    const auto message = learned.template of<at>((topic.writers & roles::deform) ? deform_run() : haptic_run());
    for (int k = 0; k < 5; ++k) {
      attack.dispose(message);
      system().watch(1ms);
      attack.unregister(message);
      system().watch(1ms);
    }
  });
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, AContactOfAToolThatIsNotThereDoesNotStopTheSurfaces) {
  const auto contacts = writer(topics::contact_state);
  for (std::uint32_t tool = 3; tool < 100; ++tool)
    contacts->write({.tool = tool, .run = haptic_run(), .seq = 1, .step = hand().newest().step, .sense_ns = now_ns()});
  EXPECT_TRUE(system().pictures_go_on(3s));
}

TEST_P(Hostile, ATimeToComeAndAStepToComeDoNotShutTheRealNodeOut) {
  const auto contacts = writer(topics::contact_state);
  const auto surfaces = writer(topics::surface_state);
  constexpr std::int64_t future = 2'000'000'000'000'000'000;
  contacts->write({.tool = 1, .run = haptic_run(), .seq = 1, .step = ~0ull, .sense_ns = future});
  SurfaceState surface{.body = 0, .run = haptic_run(), .seq = 1, .step = ~0ull, .sense_ns = future};
  surface.position.resize(3 * 405);
  surface.normal.resize(3 * 405);
  surfaces->write(surface);
  system().watch(100ms);
  EXPECT_TRUE(system().pictures_go_on(3s));
}

TEST_P(Hostile, ToolsWithoutNumberCostNoMemory) {
  const auto tools = writer(topics::tool_state);
  const auto contacts = writer(topics::contact_state);
  EXPECT_LT(grown_in_flood(long_form() ? 2'000'000 : 30'000,
                           [&](std::uint32_t k) {
                             tools->write({.tool = 100 + k, .run = haptic_run(), .seq = 1});
                             contacts->write({.tool = 100 + k, .run = haptic_run(), .seq = 1});
                           }),
            kFlood);
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, KeysThatAreDisposedWithoutNumberCostNoMemory) {
  const auto tools = writer(topics::tool_state);
  const auto contacts = writer(topics::contact_state);
  const auto status = writer(topics::node_status);
  EXPECT_LT(grown_in_flood(long_form() ? 2'000'000 : 20'000,
                           [&](std::uint32_t k) {
                             tools->dispose({.tool = k});
                             contacts->dispose({.tool = k});
                             status->dispose({.node = fmt::format("render {}@there", k)});
                           }),
            kFlood);
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, QuestionsForTheTimeUnderEverNewNamesKeepTheHapticNodeFromNothing) {
  const auto probes = writer(topics::clock_probe);
  EXPECT_LT(
      grown_in_flood(
          long_form() ? 2'000'000 : 40'000,
          [&](int k) { probes->write({.node = fmt::format("render {}@there", k), .seq = 1, .publish_ns = now_ns()}); }),
      kFlood);
}

TEST_P(Hostile, AFloodOfSamplesAsFastAsTheyGoCostsNoStep) {
  const auto models = writer(topics::local_contact_model);
  const auto tools = writer(topics::tool_state);
  const auto devices = writer(topics::device_state);
  LocalContactModel model = press(haptic_run(), deform_run(), hand().newest().step, 2'000'000);
  model.contacts.clear();
  ToolState tool{.tool = kHovering, .run = haptic_run(), .depth = 0.186};
  DeviceState device{.tool = kDriven, .depth = kPressed};
  std::atomic<bool> over = false;
  std::uint64_t sent = 0;
  const std::int64_t begin = now_ns();
  std::thread flood([&] {
    while (!over) {
      ++model.seq, ++tool.seq, ++device.seq;
      sent += models->write(model) + tools->write(tool) + devices->write(device);
    }
  });
  const bool pictures = system().pictures_go_on(10s);
  system().watch(long_form() ? 60s : 2s);
  over = true;
  flood.join();
  fmt::print("{:.0f} kHz of three topics together\n",
             1e6 * static_cast<double>(sent) / static_cast<double>(now_ns() - begin));
  EXPECT_TRUE(pictures);
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, WhatOthersSayToHaveBeenCutDoesNotFillTheDeformNode) {
  const auto held = writer(topics::held_topology);
  for (std::uint64_t seq = 1; seq <= 20'000; ++seq) {
    held->write({.node = "render 1@nowhere", .body = 0, .run = deform_run(), .seq = seq, .removed = {1, 2, 3}});
    if (seq % 200 == 0) system().watch(1ms);
  }
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood)) << "the deform node hears nothing any more";
}

TEST_P(Hostile, ASecondHapticAndASecondDeformNodeAreNotFollowedNorWhenTheOwnerStandsForAMoment) {
  const auto status = writer(topics::node_status);
  const auto contacts = writer(topics::contact_state);
  const auto models = writer(topics::local_contact_model);
  NodeStatus haptic = system().statuses()["haptic"], deform = system().statuses()["deform"];
  haptic.node = "haptic 1@nowhere", haptic.run = 3;
  deform.node = "deform 1@nowhere", deform.run = 5;
  for (std::uint64_t k = 0; k < 600; ++k) {
    if (k == 300) system().pause("deform");  // longer than its writers may be silent
    if (k == 400) system().go_on("deform");
    if (k % 50 == 0) haptic.seq = deform.seq = k + 1, status->write(haptic), status->write(deform);
    contacts->write({.tool = 1, .run = 3, .seq = k + 1, .step = k, .sense_ns = now_ns()});
    models->write(press(haptic_run(), 5, hand().newest().step - 2, k + 1));
    system().watch(1ms);
  }
  EXPECT_LT(hand().of(kHovering).max_force(), 0.1);
  EXPECT_TRUE(system().pictures_go_on(3s));
}

TEST_P(Hostile, WhoTakesTheNamesOfTheRealNodesIsNotFollowed) {
  const auto status = writer(topics::node_status);
  const auto contacts = writer(topics::contact_state);
  const auto models = writer(topics::local_contact_model);
  NodeStatus haptic = system().statuses()["haptic"], deform = system().statuses()["deform"];
  haptic.run = 3, deform.run = 5;
  const std::uint64_t run = haptic_run();
  std::atomic<bool> over = false;
  std::atomic<std::uint64_t> step = hand().newest().step;
  std::thread pretender([&] {
    for (std::uint64_t k = 1; !over; ++k) {
      haptic.seq = deform.seq = k, status->write(haptic), status->write(deform);
      contacts->write({.tool = 1, .run = 3, .seq = k, .step = k, .sense_ns = now_ns()});
      models->write(press(run, 5, step - 2, k));
      std::this_thread::sleep_for(2ms);
    }
  });
  system().watch(2s, [&] { return step = hand().newest().step, false; });
  const bool pictures = system().pictures_go_on(500ms);
  over = true;
  pretender.join();
  EXPECT_TRUE(pictures);
  EXPECT_LT(hand().of(kHovering).max_force(), 0.1);
  EXPECT_TRUE(system().watch(3s, [] { return says("haptic", "messages are refused"); })) << "it says so";
}

TEST_P(Hostile, ANodeWithoutASceneIsNoneOfThisScene) {
  const auto status = writer(topics::node_status);
  const auto models = writer(topics::local_contact_model);
  NodeStatus deform = system().statuses()["deform"];
  deform.node = "deform 0@nowhere", deform.run = 7;
  deform.scene_hash.clear(), deform.archive_hash.clear();
  for (std::uint64_t k = 0; k < 200; ++k) {
    deform.seq = k + 1;
    status->write(deform);
    models->write(press(haptic_run(), 7, hand().newest().step - 2, k + 1));
    system().watch(1ms);
  }
  EXPECT_LT(hand().of(kHovering).max_force(), 0.1);
}

TEST_P(Hostile, WhatANodeSaysOfItselfIsNoMoreThanText) {
  const auto status = writer(topics::node_status);
  NodeStatus odd = system().statuses()["render"];
  odd.node = "render \x1b[2J\xff\xfe", odd.text = "\xc3\x28 \x1b]0;\x07";
  for (std::uint64_t k = 0; k < 12; ++k) {
    odd.seq = k + 1;
    status->write(odd);
    system().watch(50ms);
  }
  EXPECT_TRUE(system().all_run());
}

TEST_P(Hostile, CutsWithoutEndCostNoMemory) {
  const auto changes = writer(topics::topology_change);
  TopologyChange change{.body = 0, .run = deform_run(), .cause = fell_away};
  change.removed.assign(60'000, 1);
  for (change.seq = 2; change.seq < 150; ++change.seq) {
    changes->write(change);
    system().watch(1ms);
  }
  for (change.seq = 1'000'000'000; change.seq < 1'000'000'300; ++change.seq) changes->write(change);
  EXPECT_TRUE(system().pictures_go_on(3s));
}

TEST_P(Hostile, CutsLargerThanTheTissueCostNoMemory) {
  const auto changes = writer(topics::topology_change);
  TopologyChange change{.body = 0, .run = deform_run(), .cause = fell_away};
  change.removed.assign(250'000, 1);
  const Memory before = system().memory_mb();
  double grown = 0, sent_mb = 0;
  for (change.seq = 2; change.seq < 600; ++change.seq) {
    sent_mb += changes->write(change);
    if (change.seq % 10 == 0) grown = std::max(grown, grown_since(before));
  }
  fmt::print("{:.0f} MB sent, {:.0f} MB more\n", sent_mb, grown);
  EXPECT_TRUE(grown < kFlatMb || testing::kSanitized) << grown << " MB";
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, WhatWasRecordedAndIsPlayedAgainIsNotFelt) {
  const auto tools = writer(topics::tool_state);
  const auto contacts = writer(topics::contact_state);
  const auto models = writer(topics::local_contact_model);
  Learned learned(system().attacker().bus(),
                  std::tuple{topics::tool_state, topics::contact_state, topics::local_contact_model});
  std::vector<ToolState> old_tools;
  std::vector<ContactState> old_contacts;
  std::vector<LocalContactModel> old_models;
  for (int k = 0; k < 100; ++k) {
    system().watch(2ms);
    learned.take();
    old_tools.push_back(learned.of<0>(haptic_run()));
    old_contacts.push_back(learned.of<1>(haptic_run()));
    old_models.push_back(learned.of<2>(deform_run()));
  }
  system().watch(200ms);
  for (std::size_t k = 0; k < old_tools.size(); ++k) {
    tools->write(old_tools[k]);
    contacts->write(old_contacts[k]);
    models->write(old_models[k]);
    if (k % 4 == 0) system().watch(1ms);
  }
  EXPECT_LT(hand().of(kHovering).max_force(), 0.1);
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
}

TEST_P(Hostile, NodesEndAsTheyShouldAndSayWhatTheyRefused) {
  std::map<std::string, nlohmann::json> said = system().end();
  ended_ = true;
  for (const char* name : {"deform", "render", "web", "haptic"}) ASSERT_TRUE(said.contains(name)) << name;
  EXPECT_GT(said["haptic"].value("refused_messages", 0), 0);
  EXPECT_GT(said["haptic"].value("implausible_models", 0) + said["haptic"].value("implausible_force_steps", 0), 0);
  EXPECT_GE(rate_hz(said["haptic"]), kMinHzOfAll);
  EXPECT_EQ(said["haptic"].value("dropped", -1), 0) << "steps that the log would lack";
  EXPECT_GT(said["deform"].value("refused", 0), 0);
  EXPECT_GT(said["render"].value("refused", 0), 0);
  EXPECT_GT(said["web"].value("refused_messages", 0), 0);
}

INSTANTIATE_TEST_SUITE_P(Open, Hostile, ::testing::Values(false));
INSTANTIATE_TEST_SUITE_P(WithKeys, Hostile, ::testing::Values(true));

}  // namespace
}  // namespace palpate::testing
