#include <signal.h>

#include <future>
#include <regex>
#include <set>

#include "common/bus/log_reader.hpp"
#include "common/realtime/clock.hpp"
#include "tests/bus/domain.hpp"
#include "tests/network/nodes.hpp"
#include "tests/network/observer.hpp"
#include "tests/network/security/secured_test.hpp"
#include "tests/sanitized.hpp"

/// The programs themselves, with the keys of their roles.
namespace palpate::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class SecuredScene : public NetworkScene {
 public:
  explicit SecuredScene(const std::string& name) : NetworkScene(name) {
    replace("[render]\n", "[network.security]\nkeys = \"keys\"\n\n[render]\n");
    keys::make_folder(keys(), this_month());
  }
  fs::path keys() const { return folder() / "keys"; }
};

template <TwoHosts::Link link>
class NodesWithKeys : public ::testing::Test {
 protected:
  void SetUp() override {
    PALPATE_TWO_HOSTS_OR_SKIP(hosts_, link)
    precompute(scene_);
    nodes_ = std::make_unique<Nodes>(*hosts_, scene_);
    observer_ = std::make_unique<Observer>(*hosts_, scene_.keys());
  }
  void TearDown() override {
    if (!HasFailure() || !nodes_) return;
    for (const char* name : {"haptic_node", "deform_node", "render_node"})
      fmt::print("{}:\n{}\n", name, nodes_->said(name));
  }

  bool joined(std::chrono::milliseconds limit) {
    const std::uint64_t before = observer_->tool.step;
    return observer_->listen(limit, [&] {
      return observer_->tool.run != 0 && observer_->surface.run == observer_->tool.run &&
             observer_->surface.step > before && observer_->surface.step > 600;
    });
  }
  struct Result {
    int status;
    std::string said;
    bool says(const std::string& words) const { return said.find(words) != std::string::npos; }
  };
  /// Runs a `palpate` command on host B.
  Result on_b(const std::string& arguments, int limit_s = 30) const {
    const Inside here(hosts_->b());
    Result result;
    result.status =
        run_command(fmt::format("timeout {} {} {} --domain {} --interface {} --peer {}", limit_s, program("palpate"),
                                arguments, Nodes::kDomain, TwoHosts::device, TwoHosts::address_a),
                    &result.said);
    return result;
  }
  std::future<Result> meanwhile_on_b(const std::string& arguments) const {
    return std::async(std::launch::async, [=, this] { return on_b(arguments); });
  }
  std::string with_keys(const std::string& role) const { return " --keys " + (scene_.keys() / role).string(); }

  SecuredScene scene_{::testing::UnitTest::GetInstance()->current_test_info()->name()};
  std::unique_ptr<TwoHosts> hosts_;
  std::unique_ptr<Nodes> nodes_;
  std::unique_ptr<Observer> observer_;
};

using SecuredNodes = NodesWithKeys<TwoHosts::Link::veth>;
using SecuredNodesOnABadLink = NodesWithKeys<TwoHosts::Link::relay>;
class SecuredCommands : public SecuredNodes {};

TEST_F(SecuredNodesOnABadLink, JoinDespiteLossesAndGoOnAtOnceAfterACut) {
  hosts_->impair("both delay 0.01 jitter 0.005 loss 0.05");
  ChildProcess haptic = nodes_->on_a("haptic_node"), deform = nodes_->on_b("deform_node");
  ASSERT_TRUE(joined(30s));
  hosts_->impair("both cut 1");
  observer_->listen(3s);
  hosts_->impair("both cut 0");
  const std::int64_t back = now_ns();
  EXPECT_TRUE(observer_->listen(5s, [&] { return first_since(observer_->surfaces, back) != 0; }));
  RecordProperty("back_after_ms", fmt::format("{:.0f}", 1e-6 * static_cast<double>(now_ns() - back)));
  EXPECT_LT(now_ns() - back, 1'000'000'000) << "they still know each other";
}

TEST_F(SecuredNodes, AllJoinTheSurfaceFollowsTheToolAndAKilledNodeComesBack) {
  ChildProcess haptic = nodes_->on_a("haptic_node"), render = nodes_->on_a("render_node");
  {
    ChildProcess deform = nodes_->on_b("deform_node");
    ASSERT_TRUE(joined(20s));
    const std::int64_t begin = now_ns();
    observer_->listen(1s);
    const auto shown = ages(observer_->surfaces, begin);
    EXPECT_GT(shown.size(), 30u);
    EXPECT_LT(at_share(shown, 0.5), 0.1);
    EXPECT_TRUE(observer_->listen(30s, [&] { return first_since(observer_->pictures, begin) != 0; }))
        << "the picture follows";
    kill(deform.pid(), SIGKILL);
    ASSERT_TRUE(deform.wait(2s));
  }
  observer_->listen(500ms);  // whatever was on its way
  const std::int64_t killed = now_ns();
  ChildProcess again = nodes_->on_b("deform_node");
  EXPECT_TRUE(observer_->listen(10s, [&] { return first_since(observer_->surfaces, killed) != 0; })) << "joins again";
  RecordProperty("back_after_s", fmt::format("{:.2f}", 1e-9 * static_cast<double>(now_ns() - killed)));
}

TEST_F(SecuredCommands, RecordTopAndReplayTakePartWithTheirOwnKeysOnly) {
  ChildProcess haptic = nodes_->on_a("haptic_node"), deform = nodes_->on_b("deform_node");
  ASSERT_TRUE(joined(20s));
  const auto file = [&](const char* name) { return (scene_.folder() / name).string(); };
  const Result wrong = on_b("record -o " + file("wrong.lcmlog") + with_keys("observer"));
  // As long as it takes to join: their seconds count from their start.
  for (const double seconds : {2.5, 8., 20.}) {
    auto recorder = meanwhile_on_b(
        fmt::format("record --force --seconds {} -o {}{}", seconds, file("far.lcmlog"), with_keys("recorder")));
    auto stranger = meanwhile_on_b(fmt::format("record --force --seconds {} -o {}", seconds, file("stranger.lcmlog")));
    auto observer = meanwhile_on_b(fmt::format("top --once --interval {}{}", seconds, with_keys("observer")));
    const Result recorded = recorder.get(), strange = stranger.get(), seen = observer.get();
    EXPECT_EQ(recorded.status, 0);
    EXPECT_EQ(seen.status, 0);
    EXPECT_EQ(strange.status, 0);
    EXPECT_FALSE(strange.says("palpate/force_state") || strange.says("palpate/tool_state"))
        << "nothing but its own comes without keys: " << strange.said;
    const bool hears = std::regex_search(recorded.said, std::regex("palpate/force_state +[0-9]{3}")),
               sees = seen.says("haptic");
    if (hears && sees) break;
    EXPECT_TRUE(seconds < 20) << recorded.said << seen.said;
  }
  EXPECT_EQ(wrong.status, 1);
  EXPECT_TRUE(wrong.says("holds keys of the role 'observer', and this program's is 'recorder'")) << wrong.said;

  haptic.interrupt();
  ASSERT_TRUE(haptic.wait(5s));
  observer_->listen(500ms);
  observer_->tool = {};
  const auto heard = [&] { return observer_->tool.step > 0; };
  for (int time = 0; time < 3 && !heard(); ++time) {  // it waits a second for who listens
    auto replay = meanwhile_on_b("replay " + file("far.lcmlog") + with_keys("player"));
    observer_->listen(10s, heard);
    EXPECT_EQ(replay.get().status, 0);
  }
  EXPECT_TRUE(heard()) << "the log is heard";
}

TEST_F(SecuredCommands, LatencyIsMeasuredWithKeysAndNotWithout) {
  const auto answer = [&](const std::string& keys) {
    const Inside here(hosts_->a());
    return ChildProcess("palpate",
                        {"/bin/sh", "-c",
                         fmt::format("exec {} latency --answer --json --domain {} --interface {} --peer {} {}",
                                     program("palpate"), Nodes::kDomain, TwoHosts::device, TwoHosts::address_b, keys)});
  };
  ChildProcess other = answer(with_keys("latency"));
  const Result secured = on_b("latency --seconds 1 --rate 200" + with_keys("latency"));
  EXPECT_EQ(secured.status, 0);
  EXPECT_TRUE(secured.says("the bus takes ")) << secured.said;
  EXPECT_EQ(on_b("latency --seconds 0.1", 3).status, 124) << "still waits for an answer";
}

/// Each topic of a scene may be written and read by whom the scene needs for it.
class SecuredScenes : public ::testing::TestWithParam<std::pair<const char*, std::set<std::string>>> {};

TEST_P(SecuredScenes, RunWithKeys) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("palpate-secured-{}", getpid());
  fs::remove_all(folder);
  keys::make_folder(folder / "keys", this_month());
  const auto& [scene, topics] = GetParam();
  std::string said;
  std::set<std::string> missing;
  // As long as it takes to join: the haptic node's seconds count from its start.
  for (const double seconds : {kSanitized ? 4 : 1.7, 6., 20.}) {
    EXPECT_EQ(
        run_command(
            fmt::format("{} run {}/scenes/{}.toml --processes 2 --seconds {} --domain {} --keys {} --force --record {}",
                        program("palpate"), PALPATE_SOURCE, scene, seconds, own_domain(), (folder / "keys").string(),
                        (folder / "all.lcmlog").string()),
            &said),
        0)
        << said;
    missing = topics;
    LogReader log(folder / "all.lcmlog");
    for (LogEvent event; log.next(event);) missing.erase(event.channel.substr(event.channel.find('/') + 1));
    if (missing.empty()) break;
  }
  for (const std::string& topic : missing) ADD_FAILURE() << topic << "\n" << said;
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(
    Example, SecuredScenes,
    ::testing::Values(
        std::pair("plate_cut", std::set<std::string>{"tool_state", "force_state", "surface_state", "topology_change",
                                                     "held_topology", "local_contact_model", "deform_step",
                                                     "deform_keyframe", "picture_state", "clock_answer"}),
        std::pair("catheter_insertion", std::set<std::string>{"tool_state", "modal_state", "catheter_state",
                                                              "task_record", "haptic_keyframe", "scene"})),
    [](const auto& info) { return info.param.first; });

/// Libraries that a process has loaded, by name.
std::set<std::string> libraries_of(pid_t pid) {
  std::ifstream maps(fmt::format("/proc/{}/maps", pid));
  std::set<std::string> names;
  for (std::string line; std::getline(maps, line);)
    if (const std::size_t at = line.rfind('/'); at != line.npos && line.find(".so", at) != line.npos)
      names.insert(line.substr(at + 1));
  return names;
}

std::set<std::string> libraries_with(const std::string& scene, const std::string& keys) {
  const auto ready = [](ChildProcess& n) { return !n.take_lines().empty(); };
  ChildProcess node("deform_node", {"/bin/sh", "-c",
                                    fmt::format("exec {} {} --supervised --domain {} {}", program("deform_node"), scene,
                                                own_domain(), keys)});
  for (int i = 0; i < 1000 && !ready(node); ++i) std::this_thread::sleep_for(10ms);
  return libraries_of(node.pid());
}

TEST(SecurityOff, NothingOfItIsLoaded) {
  const LoopbackScene scene("security-off", kLinear);
  precompute(scene);
  keys::make_folder(scene.folder() / "keys", this_month());
  const std::set<std::string> plugins{"libdds_security_ac.so", "libdds_security_auth.so", "libdds_security_crypto.so"};
  const auto off = libraries_with(scene.scene(), ""),
             on = libraries_with(scene.scene(), "--keys " + (scene.folder() / "keys").string());
  EXPECT_TRUE(std::ranges::any_of(off, [](const std::string& name) { return name.starts_with("libddsc.so"); }));
  std::set<std::string> more;
  std::ranges::set_difference(on, off, std::inserter(more, more.end()));
  EXPECT_EQ(more, plugins) << "and these are all that keys load";
  for (const std::string& name : off) EXPECT_EQ(name.find("dds_security"), name.npos) << name;
}

TEST(SecurityOff, MissingKeysAreSaidInWords) {
  const LoopbackScene scene("security-missing", kLinear);
  scene.replace("[render]\n", "[network.security]\nkeys = \"keys\"\n\n[render]\n");
  std::string said;
  EXPECT_EQ(run_command(program("palpate") + " check " + scene.scene(), &said), 0);
  EXPECT_NE(said.find("/keys is not there, so that no node starts; `palpate keys` makes it"), said.npos) << said;
  precompute(scene);
  EXPECT_EQ(run_command(program("deform_node") + " " + scene.scene(), &said), 1);
  EXPECT_EQ(
      said,
      fmt::format(
          "deform_node: network: there is no folder of keys {}/keys: `palpate keys` makes one, see docs/security.md\n",
          scene.folder().string()));
}

TEST(KeysCommand, MakesAddsAndNeverWritesOver) {
  const LoopbackScene scene("keys-command");
  const std::string keys = (scene.folder() / "keys").string();
  std::string said;
  EXPECT_EQ(run_command(program("palpate") + " keys --days 10 " + keys, &said), 0);
  EXPECT_NE(said.find("authority/ stays here"), said.npos) << said;
  EXPECT_NE(said.find("[network.security]"), said.npos) << said;
  EXPECT_EQ(run_command(program("palpate") + " keys " + keys, &said), 1);
  EXPECT_NE(said.find("is there already; nothing was written"), said.npos) << said;
  EXPECT_EQ(run_command(program("palpate") + " keys --add render --name wall " + keys, &said), 0);
  EXPECT_TRUE(fs::exists(keys + "/wall/key.pem"));
  EXPECT_EQ(run_command(program("palpate") + " keys --add surgeon " + keys, &said), 1)
      << "the roles are listed: " << said;
  EXPECT_NE(run_command(program("palpate") + " keys --days 0 " + keys, &said), 0);
}

}  // namespace
}  // namespace palpate::testing
