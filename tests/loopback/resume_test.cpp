#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <thread>

#include "common/bus/dds_bus.hpp"
#include "common/bus/presence.hpp"
#include "common/realtime/clock.hpp"
#include "tests/bus/domain.hpp"
#include "tests/loopback/loopback_scene.hpp"
#include "tools/shared/child_process.hpp"

namespace palpate {
namespace {

using namespace std::chrono_literals;
using testing::kLinear;
using testing::LoopbackScene;
using testing::own_domain;
using testing::program;
using testing::run_command;

/// A driver that holds the tool at a depth, as a device elsewhere would.
class Driver {
 public:
  Driver()
      : bus_(make_dds_bus({.domain = own_domain()})),
        writer_(bus_->writer(topics::device_state)),
        forces_(bus_->reader(topics::force_state)) {}

  /// Publishes for a while at about 500 Hz and returns the last force that came back.
  std::optional<ForceState> drive(double from, double to, std::chrono::milliseconds time) {
    std::optional<ForceState> last;
    const auto begin = std::chrono::steady_clock::now();
    for (auto now = begin; now < begin + time; now = std::chrono::steady_clock::now()) {
      const double share = std::chrono::duration<double>(now - begin) / std::chrono::duration<double>(time);
      if (const auto force = step(from + share * (to - from))) last = force;
    }
    return last;
  }
  Bus& bus() { return *bus_; }
  /// Holds the tool there until `enough` says so; false if that is not within ten seconds.
  template <class Enough>
  bool hold(double depth, Enough&& enough) {
    const auto limit = std::chrono::steady_clock::now() + 10s;
    while (!enough(step(depth)))
      if (std::chrono::steady_clock::now() > limit) return false;
    return true;
  }

 private:
  std::optional<ForceState> step(double depth) {
    writer_->write({.tool = 0, .seq = ++seq_, .sense_ns = now_ns(), .depth = depth});
    std::this_thread::sleep_for(2ms);
    std::optional<ForceState> last;
    while (auto force = forces_->take()) last = *force;
    return last;
  }

  std::unique_ptr<Bus> bus_;
  std::unique_ptr<Writer<DeviceState>> writer_;
  std::unique_ptr<Reader<ForceState>> forces_;
  std::uint64_t seq_ = 0;
};

/// A block under a tool that a driver elsewhere holds.
struct ResumedScene : LoopbackScene {
  explicit ResumedScene(const std::string& rule = "patch") : LoopbackScene("resume", kLinear) {
    replace("[render]\n", fmt::format("[contact]\nrule = \"{}\"\n\n[render]\n", rule));
    replace("device = \"scripted\"\ntrajectory = \"motion.csv\"", "device = \"bus\"");
    std::string said;
    if (run_command(program("palpate") + " precompute " + scene(), &said) != 0) throw std::runtime_error(said);
  }
  ChildProcess start(const std::string& name) const {
    return {name, {program(name), scene(), "--domain", std::to_string(own_domain())}};
  }
};

TEST(Resume, AHapticNodeKilledInContactComesBackIntoItAndAFreshOneIsRefused) {
  const ResumedScene scene;
  Driver driver;
  ChildProcess deform = scene.start("deform_node");
  double held = 0;
  std::uint64_t run = 0;
  {
    ChildProcess haptic = scene.start("haptic_node");
    ASSERT_TRUE(driver.hold(0.18, [](const auto& force) { return force && force->step > 300; }));
    const auto pressed = driver.drive(0.18, 0.198, 1000ms);
    const auto rest = driver.drive(0.198, 0.198, 300ms);
    ASSERT_TRUE(pressed && rest);
    held = rest->force[2];
    ASSERT_GT(held, 0.1);
    run = rest->run;
    kill(haptic.pid(), SIGKILL);
    ASSERT_TRUE(haptic.wait(5s));
  }
  {
    ChildProcess again = scene.start("haptic_node");
    EXPECT_TRUE(driver.hold(0.198, [&](const auto& force) {
      return !again.running() || (force && force->run != run && force->step > 300);
    }));
    const auto force = driver.drive(0.198, 0.198, 500ms);
    ASSERT_TRUE(again.running()) << "it takes up the contacts that the deformation node kept";
    ASSERT_TRUE(force);
    EXPECT_NEAR(force->force[2], held, 0.02 * held);
    kill(again.pid(), SIGKILL);
    ASSERT_TRUE(again.wait(5s));
  }
  kill(deform.pid(), SIGKILL);
  ASSERT_TRUE(deform.wait(5s));
  std::this_thread::sleep_for(500ms);
  ChildProcess fresh = scene.start("haptic_node");
  EXPECT_TRUE(driver.hold(0.198, [&](const auto&) { return !fresh.running(); }))
      << "nobody keeps its contacts: it must not start inside the organ";
  EXPECT_EQ(fresh.status(), 1);
}

/// What a deformation node and the haptic node beside it said last.
struct Told {
  NodeStatus deform;
  ContactState contacts;

  explicit Told(Bus& bus) : statuses_(bus.reader(topics::node_status)), contacts_(bus.reader(topics::contact_state)) {}
  void take() {
    while (const auto status = statuses_->take())
      if (status->role == "deform") deform = *status;
    while (const auto state = contacts_->take())
      if (!state->contacts.empty()) contacts = *state;
  }

 private:
  std::unique_ptr<Reader<NodeStatus>> statuses_;
  std::unique_ptr<Reader<ContactState>> contacts_;
};

/// Stands in for a deformation node that keeps contacts for a haptic node's return, while somebody else tells it of
/// false ones, before and behind the true ones. It says who it is once all have come to the haptic node.
class Keeper {
 public:
  Keeper(Bus& bus, const Told& told, ContactState forged)
      : bus_(bus),
        told_(told),
        false_(std::move(forged)),
        forged_(bus.writer(topics::held_contacts)),
        kept_(bus.writer(topics::held_contacts)) {
    EXPECT_TRUE(forged_->write(false_) && kept_->write(told.contacts));
    std::this_thread::sleep_for(200ms);  // readers that were killed are met again
    before_ = kept_->readers();
  }
  void look() {
    if (presence_ || kept_->readers() == before_) return;
    ++looks_;
    if (looks_ == 50) forged_->write(false_);
    if (looks_ == 100) presence_.emplace(bus_, "deform", 0, told_.deform.scene_hash, told_.deform.archive_hash);
  }

 private:
  Bus& bus_;
  const Told& told_;
  ContactState false_;
  std::unique_ptr<Writer<ContactState>> forged_, kept_;
  int before_ = 0, looks_ = 0;  ///< readers; looks, a few milliseconds apart, since another has come
  std::optional<Presence> presence_;
};

TEST(Resume, ForgedContactsBesideTrueOnesDoNotKeepTheNodeFromComingBackNorChangeItsForce) {
  const ResumedScene scene("barycentric");  // a patch lies where its tool is, whatever anybody says

  Driver driver;
  Told told(driver.bus());
  double held = 0;
  std::uint64_t run = 0;
  {
    ChildProcess deform = scene.start("deform_node"), haptic = scene.start("haptic_node");
    ASSERT_TRUE(driver.hold(0.18, [](const auto& force) { return force && force->step > 300; }));
    driver.drive(0.18, 0.198, 1000ms);
    const auto rest = driver.drive(0.198, 0.198, 300ms);
    ASSERT_TRUE(rest);
    held = rest->force[2], run = rest->run;
    told.take();
    ASSERT_FALSE(told.contacts.contacts.empty());
    for (ChildProcess* node : {&haptic, &deform}) {
      kill(node->pid(), SIGKILL);
      ASSERT_TRUE(node->wait(5s));
    }
  }
  using Contacts = std::vector<HeldContact>;
  const std::vector<std::pair<const char*, std::function<void(Contacts&)>>> lies{
      {"on a node that the body lacks", [](Contacts& c) { c.at(0).nodes[2] = 100'000; }},
      {"more than it can hold", [](Contacts& c) { c.resize(200, Contacts(c).at(0)); }},
      {"far from the tool", [](Contacts& c) {
         c.resize(90, Contacts(c).at(0));
         for (std::uint32_t k = 0; k < c.size(); ++k) c[k].nodes.fill(k), c[k].weights = {1, 0, 0};
       }}};
  for (const auto& [what, lie] : lies) {
    ContactState forged = told.contacts;
    lie(forged.contacts);
    Keeper keeper(driver.bus(), told, forged);
    ChildProcess again = scene.start("haptic_node");
    EXPECT_TRUE(driver.hold(0.198, [&](const auto& force) {
      keeper.look();
      return !again.running() || (force && force->run != run && force->step > 300);
    })) << what;
    const auto force = driver.drive(0.198, 0.198, 500ms);
    ASSERT_TRUE(again.running()) << what;
    ASSERT_TRUE(force) << what;
    EXPECT_NEAR(force->force[2], held, 0.02 * held) << what;
    run = force->run;
    kill(again.pid(), SIGKILL);
    ASSERT_TRUE(again.wait(5s));
  }
}

}  // namespace
}  // namespace palpate
