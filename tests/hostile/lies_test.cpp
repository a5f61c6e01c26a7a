// Single messages in the names of the real nodes and drivers: of what cannot be, spoilt, or heard before.
#include "common/realtime/clock.hpp"
#include "tests/fuzz/rounds.hpp"
#include "tests/hostile/hostile.hpp"
#include "tests/hostile/learned.hpp"
#include "tests/hostile/mutations.hpp"
#include "tests/hostile/random_mutation.hpp"

namespace palpate::testing {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::milliseconds kForgotten{2700};  // after which a run that is not heard is anybody's
constexpr std::chrono::minutes kLong{20};  // with PALPATE_LONG_TESTS; the other cases take some minutes then

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

// Where the deform node has not been heard for a while, its run is anybody's.
TEST_P(Hostile, ATissueThatPressesAToolInFreeAirIsNotFelt) {
  const auto models = writer(topics::local_contact_model);
  system().pause("deform");
  system().watch(kForgotten);
  for (std::uint64_t k = 0; k < 200; ++k) {
    models->write(press(haptic_run(), deform_run(), hand().newest().step - 2, 1'000'000 + k));
    system().watch(1ms);
  }
  system().go_on("deform");
  EXPECT_TRUE(system().watch(kAfterFlood, [] { return says("haptic", "local contact model"); })) << "it says so";
}

TEST_P(Hostile, EveryFieldAtItsExtremes) {
  Learned learned(system().attacker().bus(), topics::all);
  system().watch(400ms);
  learned.take();
  int kinds = 0, sent = 0;
  for_each_topic_of_nodes([&](auto at) {
    const auto& topic = std::get<at>(topics::all);
    const auto attack = system().attacker().writer(topic);
    wait_until_it_reaches_all(attack);
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
  EXPECT_TRUE(system().watch(
      kAfterFlood, [] { return says("render", "messages are refused") || says("web", "messages are refused"); }));
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
  std::apply([](const auto&... made) { (wait_until_it_reaches_all(*made), ...); }, writers);
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
  const auto lie = [&](int round) {
    std::mt19937_64 random(round);
    learned.take();
    LocalContactModel model = learned.of<0>(deform_run());
    RandomMutation(random).spoil(model);
    models->write(model);
    system().watch(1ms);
  };
  repeat(300, 5min, lie);
  system().pause("deform");
  system().watch(kForgotten);
  for (int round = 0; round < 300; ++round) lie(round);
  system().go_on("deform");
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
    wait_until_it_reaches_all(attack);
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
  EXPECT_TRUE(system().pictures_go_on(kAfterFlood));
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

}  // namespace
}  // namespace palpate::testing
