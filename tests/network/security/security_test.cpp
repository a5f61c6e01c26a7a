#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <thread>
#include <utility>
#include <vector>

#include "tests/network/security/secured_test.hpp"

/// Who may not take part neither reads nor writes: samples counted at both ends, beside some who may.
namespace palpate::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr int kDomain = 7;
constexpr auto kJoin = 30s;
constexpr auto kLong = 1500ms;  ///< that all go on once they hear each other
constexpr unsigned kTool = 1, kDriver = 2, kIntruder = 9;
constexpr std::uint64_t kMany = 100;  ///< heard before that, and of 300 that are sent then

struct Hears {
  Peer* peer;
  unsigned tool;
};
/// Each of them has heard that tool many times before this time is over.
bool all_hear(std::chrono::seconds within, const std::vector<Hears>& all) {
  const auto limit = std::chrono::steady_clock::now() + within;
  while (!std::ranges::all_of(all, [](const Hears& h) { return h.peer->heard(h.tool); })) {
    if (std::chrono::steady_clock::now() > limit) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

class Secured : public ::testing::Test {
 protected:
  void SetUp() override {
    PALPATE_TWO_HOSTS_OR_SKIP(hosts_, TwoHosts::Link::veth)
    fs::remove_all(folder_);
    keys::make_folder(keys_, this_month());
  }
  void TearDown() override { fs::remove_all(folder_); }

  Peer on_a(const PeerTask& task) const {
    const Inside here(hosts_->a());
    return Peer(task, kDomain, TwoHosts::device, TwoHosts::address_b);
  }
  Peer on_b(const PeerTask& task) const {
    const Inside here(hosts_->b());
    return Peer(task, kDomain, TwoHosts::device, TwoHosts::address_a);
  }

  /// Whom, besides those who may, the test waits for.
  struct Also {
    std::vector<unsigned> intruder_hears;  ///< tools
    bool all_hear_it = false;              ///< those who may
    Peer* kin = nullptr;                   ///< hears it too
  };
  /// A haptic node's topics on host A, a driver and a render node on host B, and an intruder beside them, all at once.
  void run(const PeerTask& task, const Also& also) {
    Peer other = on_b(task);
    Peer haptic = on_a({keys_, "haptic", "tool_state,force_state", "device_state", kTool});
    Peer drives = on_b({keys_, "driver", "device_state", "force_state", kDriver});
    Peer render = on_b({keys_, "render", "-", "tool_state,force_state", 0});
    std::vector<Hears> all{{&haptic, kDriver}, {&drives, kTool}, {&render, kTool}};
    for (const unsigned tool : also.intruder_hears) all.push_back({&other, tool});
    if (also.all_hear_it) all.insert(all.end(), {{&drives, kIntruder}, {&render, kIntruder}});
    if (also.kin) all.push_back({also.kin, kIntruder});
    EXPECT_TRUE(all_hear(kJoin, all));
    std::this_thread::sleep_for(kLong);
    haptic_ = haptic.outcome();
    driver_ = drives.outcome();
    render_ = render.outcome();
    intruder_ = other.outcome();
    EXPECT_GT(haptic_.of(kDriver), kMany) << haptic_.refusal;
    EXPECT_GT(driver_.of(kTool), kMany) << driver_.refusal;
    EXPECT_GT(render_.of(kTool), kMany) << render_.refusal;
  }
  void expect_nothing_from_the_intruder(int of_its_kind = 0) const {
    EXPECT_EQ(intruder_.refusal, "");
    EXPECT_GT(intruder_.wrote, kMany) << "it did send";
    EXPECT_EQ(intruder_.readers, of_its_kind);
    for (const Outcome* honest : {&haptic_, &driver_, &render_}) EXPECT_EQ(honest->of(kIntruder), 0u);
  }
  /// The intruder's middleware lets it do anything.
  std::string lenient() const {
    const OwnMiddleware own(folder_ / "middleware");
    own.add_lenient_plugins();
    return own.environment();
  }

  const fs::path folder_ = fs::temp_directory_path() / fmt::format("palpate-security-{}", getpid());
  const fs::path keys_ = folder_ / "keys";
  std::unique_ptr<TwoHosts> hosts_;
  Outcome haptic_, driver_, render_, intruder_;
};

TEST_F(Secured, WhoHasNoCertificateNeitherReadsNorWrites) {
  run({"-", "-", "tool_state,force_state,device_state", "tool_state,force_state,device_state", kIntruder}, {});
  expect_nothing_from_the_intruder();
  EXPECT_EQ(intruder_.heard.size(), 0u);
}

TEST_F(Secured, WhoHasAForeignCertificateNeitherReadsNorWrites) {
  keys::make_folder(folder_ / "foreign", this_month());
  Peer listener = on_b({folder_ / "foreign", "observer", "-", "tool_state,force_state,device_state", 0});
  run({folder_ / "foreign", "player", "tool_state,force_state,device_state", "-", kIntruder}, {.kin = &listener});
  expect_nothing_from_the_intruder(1);
  const Outcome heard = listener.outcome();
  EXPECT_EQ(heard.refusal, "");
  EXPECT_EQ(heard.of(kTool), 0u);
  EXPECT_EQ(heard.of(kDriver), 0u);
  EXPECT_GT(heard.of(kIntruder), kMany) << "it hears its own kind";
}

TEST_F(Secured, TheWrongRoleIsRefusedByItsOwnMiddleware) {
  for (const PeerTask& task : {PeerTask{keys_, "observer", "force_state", "-", kIntruder},
                               PeerTask{keys_, "render", "tool_state", "-", kIntruder}})
    EXPECT_EQ(on_b(task).outcome_of_itself().refusal,
              fmt::format("network: creating the writer of palpate/{} is not permitted to the role of these keys",
                          task.writes));
  EXPECT_EQ(on_b({keys_, "render", "-", "device_state", kIntruder}).outcome_of_itself().refusal,
            "network: creating topic palpate/device_state is not permitted to the role of these keys");
}

TEST_F(Secured, AnObserverWritesNothingEvenWhereItsOwnMiddlewareWouldLetIt) {
  run({keys_, "observer", "tool_state,force_state,device_state", "tool_state,force_state", kIntruder, lenient()},
      {.intruder_hears = {kTool}});
  expect_nothing_from_the_intruder();
  EXPECT_GT(intruder_.of(kTool), kMany) << "it may read";
}

TEST_F(Secured, ARenderNodeNeitherWritesNorReadsWhatIsNotItsBusiness) {
  run({keys_, "render", "tool_state,force_state,device_state", "device_state", kIntruder, lenient()}, {});
  expect_nothing_from_the_intruder();
  EXPECT_EQ(intruder_.heard.size(), 0u) << "a render node reads no devices";
}

/// That the two tests above would see an intruder: with the same middleware, the role that may write is heard.
TEST_F(Secured, TheRightRoleIsHeardFromTheSameMiddleware) {
  run({keys_, "haptic", "tool_state,force_state", "device_state", kIntruder, lenient()},
      {.intruder_hears = {kDriver}, .all_hear_it = true});
  EXPECT_GT(render_.of(kIntruder), kMany) << intruder_.refusal;
  EXPECT_GT(driver_.of(kIntruder), kMany);
  EXPECT_GT(intruder_.of(kDriver), kMany);
  EXPECT_GT(intruder_.readers, 0);
}

/// Frames on host B's end of the link while a tool's state crosses it, and how many of them show its depth.
struct Seen {
  int frames = 0, readable = 0;
};

Seen listen_on(const NetworkNamespace& host, Peer& writer, Peer& reader) {
  const Inside here(host);
  const int wire = socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, htons(ETH_P_ALL));
  EXPECT_GE(wire, 0);
  const double depth = 0.0123456789;
  Seen seen;
  std::vector<char> frame(65536);
  auto end = std::chrono::steady_clock::now() + 20s;
  bool joined = false;
  while (std::chrono::steady_clock::now() < end) {
    if (!std::exchange(joined, reader.heard(kTool)) && joined) end = std::chrono::steady_clock::now() + kLong;
    pollfd waiting{wire, POLLIN, 0};
    if (poll(&waiting, 1, 50) != 1) continue;
    const ssize_t size = recv(wire, frame.data(), frame.size(), 0);
    if (size <= 0) continue;
    ++seen.frames;
    seen.readable += memmem(frame.data(), static_cast<std::size_t>(size), &depth, sizeof depth) != nullptr;
  }
  close(wire);
  EXPECT_GT(reader.outcome().of(kTool), kMany);
  EXPECT_GT(writer.outcome().wrote, kMany);
  return seen;
}

TEST_F(Secured, NobodyOnTheWireCanReadIt) {
  {
    Peer writer = on_a({"-", "-", "tool_state", "-", kTool}), reader = on_b({"-", "-", "-", "tool_state", 0});
    const Seen open = listen_on(hosts_->b(), writer, reader);
    EXPECT_GT(open.readable, static_cast<int>(kMany)) << "without keys it can be read";
  }
  Peer writer = on_a({keys_, "haptic", "tool_state", "-", kTool}),
       reader = on_b({keys_, "render", "-", "tool_state", 0});
  const Seen secured = listen_on(hosts_->b(), writer, reader);
  EXPECT_GT(secured.frames, static_cast<int>(kMany));
  EXPECT_EQ(secured.readable, 0);
}

// Keys that end before all have joined, as on a busy machine, say nothing: then longer ones are tried.
TEST_F(Secured, KeysThatEndCutOffWhoeverHasThem) {
  for (const int lasts : {4, 8, 16, 32}) {
    const std::time_t end = std::time(nullptr) + lasts;
    const std::string name = fmt::format("brief-{}", lasts);
    keys::add_keys(keys_, "render", name, {end - 64, end});
    Peer haptic = on_a({keys_, "haptic", "tool_state", "-", kTool});
    Peer lasting = on_b({keys_, "render", "-", "tool_state", 0}),
         brief = on_b({keys_ / name, "render", "-", "tool_state", 0});
    if (!all_hear(std::chrono::seconds(lasts), {{&lasting, kTool}, {&brief, kTool}})) continue;
    std::this_thread::sleep_until(std::chrono::system_clock::from_time_t(end) + 2 * kLong);
    EXPECT_EQ(haptic.outcome().refusal, "");
    std::this_thread::sleep_for(kLong);  // until both have read what had come
    const Outcome all = lasting.outcome(), until_the_end = brief.outcome();
    EXPECT_GT(until_the_end.of(kTool), kMany);
    EXPECT_GT(all.last_of(kTool), until_the_end.last_of(kTool) + 150) << "of 600 that follow";
    return;
  }
  FAIL() << "nobody joins with keys that last 32 s";
}

TEST_F(Secured, MissingPluginsAreNamedWithTheirPackage) {
  const OwnMiddleware bare(folder_ / "middleware");
  const std::string said =
      on_b({keys_, "observer", "-", "tool_state", 0, bare.environment()}).outcome_of_itself().refusal;
  EXPECT_NE(said.find("libdds_security_auth.so"), said.npos) << said;
  EXPECT_NE(said.find("Debian's package libddsc0debian has them"), said.npos) << said;
}

}  // namespace
}  // namespace palpate::testing
