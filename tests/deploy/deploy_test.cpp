#include <gtest/gtest.h>
#include <signal.h>

#include <memory>
#include <regex>
#include <set>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "tests/deploy/ssh_host.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tests/network/hosts_or_skip.hpp"
#include "tools/keys/key_folder.hpp"

namespace palpate::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr int kDomain = 5;

/// The loopback tests' block under a tool that presses for a minute.
class PressedBlock : public LoopbackScene {
 public:
  PressedBlock() : LoopbackScene("deploy", kLinear) {
    write("motion.csv", "time,yaw,pitch,depth,roll,grip\n0,0,0,0.17,0,0\n0.5,0,0,0.198,0,0\n60,0.05,0,0.198,0,0\n");
    std::string said;
    if (run_command(program("palpate") + " precompute " + scene(), &said) != 0) throw std::runtime_error(said);
  }
};

/// Two hosts, the second with an sshd.
class Deploy : public ::testing::Test {
 protected:
  void SetUp() override {
    PALPATE_TWO_HOSTS_OR_SKIP(hosts_, TwoHosts::Link::veth)
    try {
      far_ = std::make_unique<SshHost>(hosts_->b(), TwoHosts::address_b);
    } catch (const std::runtime_error& reason) {
      GTEST_SKIP() << reason.what();
    }
  }
  void TearDown() override {
    if (HasFailure()) fmt::print("{}\n", said_);
  }

  std::string line(const std::string& arguments, const std::string& ssh) const {
    return fmt::format("{}/scripts/deploy.sh {} --bin {} --ssh '{}' {}", PALPATE_SOURCE, TwoHosts::address_b,
                       PALPATE_BIN, ssh, arguments);
  }
  int deploy(const std::string& arguments, const std::string& ssh = {}) {
    return run_in(hosts_->a(), line(arguments, ssh.empty() ? far_->ssh() : ssh), said_);
  }
  /// The scene, and that a node which a failing test leaves there ends by itself.
  std::string scene() const { return fmt::format("{} --domain {} ", block_.scene(), kDomain); }
  bool said(const std::string& words) const { return said_.find(words) != std::string::npos; }

  /// Waits on host A for a surface that a haptic node on the same host caused.
  bool surface_comes(const fs::path& keys = {}) const {
    const Inside here(hosts_->a());
    const auto bus = make_dds_bus({.domain = kDomain,
                                   .interface = TwoHosts::device,
                                   .peers = {TwoHosts::address_b},
                                   .keys = keys,
                                   .role = "observer"});
    const auto surfaces = bus->reader(topics::surface_state);
    const auto limit = std::chrono::steady_clock::now() + 60s;
    while (std::chrono::steady_clock::now() < limit) {
      bus->wait(10ms);
      while (const auto surface = surfaces->take())
        if (surface->run != 0 && surface->step > 600) return true;
    }
    return false;
  }

  std::unique_ptr<TwoHosts> hosts_;
  std::unique_ptr<SshHost> far_;
  PressedBlock block_;
  std::string said_;
};

TEST_F(Deploy, ADeformNodeIsBroughtAndItsSurfacesComeBack) {
  ASSERT_EQ(deploy(scene() + "-- --seconds 120"), 0);
  EXPECT_TRUE(said("deform_node runs, process "));
  EXPECT_EQ(far_->listing(), "palpate");
  EXPECT_FALSE(fs::exists(far_->home() / "palpate/bin/haptic_node")) << "only what the node needs";
  EXPECT_EQ(deploy("--status"), 0);

  const std::string near =
      fmt::format("exec {} {} --domain {} --interface {} --peer {} --seconds 60 2>/dev/null", program("haptic_node"),
                  block_.scene(), kDomain, TwoHosts::device, TwoHosts::address_b);
  const Inside here(hosts_->a());
  ChildProcess haptic("haptic_node", {"/bin/sh", "-c", near});
  EXPECT_TRUE(surface_comes());
  haptic.interrupt();

  EXPECT_EQ(deploy("--stop"), 0);
  EXPECT_FALSE(somebody_runs(far_->home()));
  EXPECT_EQ(deploy("--status"), 1);
  EXPECT_TRUE(said("deform_node is stopped"));
  EXPECT_EQ(deploy("--remove"), 0);
  EXPECT_EQ(far_->listing(), "");
}

TEST_F(Deploy, ALaterCallReplacesTheNodesItNamesAndStopsNoOthers) {
  ASSERT_EQ(deploy(scene() + "-- --seconds 120"), 0);
  EXPECT_EQ(deploy(scene() + "--node haptic_node -- --seconds 120"), 1);
  EXPECT_TRUE(said("deform_node runs in"));
  EXPECT_EQ(deploy("--status"), 0);
  EXPECT_EQ(deploy(scene() + "--node haptic_node --node deform_node -- --seconds 120"), 0);
  EXPECT_EQ(deploy("--status"), 0);
  EXPECT_TRUE(said("haptic_node runs") && said("deform_node runs"));
  EXPECT_EQ(deploy("--stop --node haptic_node"), 0);
  EXPECT_FALSE(somebody_runs(far_->home() / "palpate/bin/haptic_node"));
  EXPECT_TRUE(somebody_runs(far_->home() / "palpate/bin/deform_node"));
  EXPECT_EQ(deploy("--remove"), 0);
  EXPECT_FALSE(somebody_runs(far_->home()));
}

TEST_F(Deploy, OfTheKeysAHostGetsThoseOfItsNodesAlone) {
  const fs::path keys = block_.folder() / "keys", there = far_->home() / "palpate/scene/keys";
  block_.replace("[render]", "[network.security]\nkeys = \"keys\"\n\n[render]");
  EXPECT_EQ(deploy(scene()), 1);
  EXPECT_TRUE(said("keys/deform is not there: palpate keys makes it"));
  constexpr std::time_t month = 30 * 24 * 60 * 60;
  keys::make_folder(keys, {std::time(nullptr) - 60, std::time(nullptr) + month});
  fs::permissions(keys / "deform/key.pem", fs::perms::others_read, fs::perm_options::add);
  EXPECT_EQ(deploy(scene()), 1);
  EXPECT_TRUE(said("key.pem may be read by others"));
  fs::permissions(keys / "deform/key.pem", fs::perms::others_read, fs::perm_options::remove);
  const auto altered =
      far_->ssh_through("altering", "LC_ALL=C sed 's/<grant name=\"deform\">/<grant name=\"haptic\">/'");
  EXPECT_EQ(deploy(scene(), altered), 1);
  EXPECT_TRUE(said("scene/keys/deform/permissions.p7s: FAILED")) << said_;
  EXPECT_EQ(far_->listing(), "");

  ASSERT_EQ(deploy(scene() + "-- --seconds 120"), 0);
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(there))
    files.insert(fmt::format("{} {:o}", fs::relative(entry.path(), there).string(),
                             static_cast<unsigned>(entry.status().permissions())));
  EXPECT_EQ(files,
            (std::set<std::string>{"deform 700", "deform/authority.pem 600", "deform/certificate.pem 600",
                                   "deform/governance.p7s 600", "deform/key.pem 600", "deform/permissions.p7s 600"}));
  const std::string near =
      fmt::format("exec {} {} --domain {} --interface {} --peer {} --seconds 60 2>/dev/null", program("haptic_node"),
                  block_.scene(), kDomain, TwoHosts::device, TwoHosts::address_b);
  const Inside here(hosts_->a());
  ChildProcess haptic("haptic_node", {"/bin/sh", "-c", near});
  EXPECT_TRUE(surface_comes(keys));
  haptic.interrupt();
  EXPECT_EQ(deploy("--remove"), 0);
  EXPECT_EQ(far_->listing(), "");
}

TEST_F(Deploy, FilesBesideTheSceneKeepTheirPlaces) {
  fs::create_directory(block_.folder() / "deeper");
  block_.replace("\"block.msh", "\"../block.msh");
  block_.replace("\"motion.csv", "\"../motion.csv");
  block_.replace("[render]\n", "[render]\nbackdrop = \"../ribs.stl\"\n");
  fs::copy_file(fs::path(PALPATE_SOURCE) / "scenes/meshes/ribs.stl", block_.folder() / "ribs.stl");
  fs::rename(block_.scene(), block_.folder() / "deeper/scene.toml");
  const std::string deeper = (block_.folder() / "deeper/scene.toml").string() + " --no-start";
  EXPECT_EQ(deploy(deeper), 0);
  EXPECT_FALSE(fs::exists(far_->home() / "palpate/lib")) << "no node there reads a mesh";
  EXPECT_EQ(deploy(deeper + " --node deform_node --node render_node"), 0);
  for (const char* file : {"block.msh", "motion.csv", "ribs.stl", "deeper/scene.toml"})
    EXPECT_TRUE(fs::exists(far_->home() / "palpate/scene" / file)) << file;
  EXPECT_FALSE(somebody_runs(far_->home() / "palpate"));
  for (const char* node : {"deform_node", "render_node"})
    EXPECT_EQ(run_in(hosts_->b(), far_->home() / fmt::format("palpate/start {} --seconds 0.1", node), said_), 0);
}

TEST_F(Deploy, DamageIsNoticed) {
  const auto altered = far_->ssh_through("altering", "LC_ALL=C sed 's/young = 5000/young = 6000/'");
  EXPECT_EQ(deploy(scene(), altered), 1);
  EXPECT_TRUE(said("scene/scene.toml: FAILED"));
  EXPECT_EQ(far_->listing(), "");
  EXPECT_EQ(deploy(scene(), far_->ssh_through("cutting", "head -c 1000000")), 1);
  EXPECT_TRUE(said("not all that was sent arrived"));
  EXPECT_EQ(far_->listing(), "");

  ASSERT_EQ(deploy(scene() + "-- --seconds 120"), 0);
  for (const auto& archive : fs::directory_iterator(far_->home() / "palpate/archives"))
    std::ofstream(archive.path(), std::ios::app) << ' ';
  EXPECT_EQ(deploy("--status"), 1);
  EXPECT_TRUE(std::regex_search(said_, std::regex("not as it was sent: archives/block-[0-9a-f]+.h5")));
  EXPECT_EQ(deploy("--remove"), 0);
}

TEST_F(Deploy, ANodeThatCannotStartLeavesNothing) {
  EXPECT_EQ(deploy(scene() + "--interface nowhere0"), 1);
  EXPECT_TRUE(said("deform_node ended at once: deform_node: network: this host has no interface 'nowhere0'"));
  EXPECT_EQ(far_->listing(), "");
}

TEST_F(Deploy, WhatIsNoDeploymentIsNotTouched) {
  block_.replace("\"motion.csv", fmt::format("\"{}/motion.csv", block_.folder().string()));
  EXPECT_EQ(deploy(scene()), 1);
  EXPECT_TRUE(said("only paths relative to the scene are the same on another host"));
  block_.replace(block_.folder().string() + "/motion.csv", "motion.csv");
  fs::create_directory(far_->home() / "palpate");
  EXPECT_EQ(deploy(scene()), 1);
  EXPECT_TRUE(said("is there and is not a deployment"));
  EXPECT_EQ(deploy("--remove"), 1);
  EXPECT_EQ(far_->listing(), "palpate");
}

TEST_F(Deploy, InterruptedItLeavesNothing) {
  const auto stalling = far_->ssh_through("stalling", "head -c 1000000; sleep 60");
  const Inside here(hosts_->a());
  ChildProcess script("deploy.sh", {"/bin/bash", "-c", "exec " + line(scene(), stalling) + " 2>&1"});
  const auto limit = std::chrono::steady_clock::now() + 60s;
  while (far_->listing() != "palpate.new" && std::chrono::steady_clock::now() < limit)
    std::this_thread::sleep_for(10ms);
  ASSERT_EQ(far_->listing(), "palpate.new");
  kill(-script.pid(), SIGINT);
  ASSERT_TRUE(script.wait(30s));
  EXPECT_EQ(script.status(), 130);
  EXPECT_EQ(far_->listing(), "");
}

}  // namespace
}  // namespace palpate::testing
