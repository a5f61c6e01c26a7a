// Tools in the hand of a page, which feels nothing, at the tissues of examples: the tool, which gives way to the
// force, and the force must not feed each other.
#include <gtest/gtest.h>

#include "common/devices/device.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/scene_changes.hpp"
#include "common/tool/motion_guard.hpp"
#include "tools/rig/tip_at.hpp"
#include "tools/rig/two_nodes.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// The first tool of an example under a pointer, tick by tick; the others stand. What moving tissue tells comes late,
/// as from a node of its own that has a busy host.
class HeldExample {
 public:
  static constexpr int kLateTicks = 4;
  static constexpr int kSampleApart = 16;  // ticks: sixty samples a second

  HeldExample(const std::string& name, const Vector3d& start, const std::vector<SceneChange>& changes = {})
      : at_(start) {
    scene_ = load_scene(std::string(PALPATE_SOURCE_DIR) + "/scenes/" + name, changes);
    scene_.tools[0].device = PointerDeviceSpec{.start = start};
    nodes_ = std::make_unique<TwoNodes>(scene_, load_or_precompute(scene_, ArchivePart::surface));
    nodes_->delay(kLateTicks);
    auto devices = make_devices(scene_.tools, scene_.rates.haptic_hz);
    for (const auto& device : devices) dofs_.push_back(device->read(0).dofs);
    device_ = std::move(devices[0]);
    guard_ = std::make_unique<MotionGuard>(scene_.tools[0].motion, kDt);
    nodes_->start(dofs_);
  }

  struct Felt {
    double most = 0, jump = 0, change = 0;  ///< [N], [N] in a tick at most and in the mean
  };
  /// The pointer goes to a place [m] at a speed [m/s].
  Felt lead(const Vector3d& to, double speed) {
    const Vector3d from = at_;
    return feel(static_cast<int>((to - from).norm() / speed / kDt),
                [&](double share) { at_ = from + share * (to - from); });
  }
  /// It is there at once, and stays so long [s].
  Felt stand_at(const Vector3d& at, double seconds) {
    at_ = at;
    return stand(seconds);
  }
  Felt stand(double seconds) {
    return feel(static_cast<int>(seconds / kDt), [](double) {});
  }
  void grip(double angle) { grip_ = angle; }
  double force() const { return nodes_->force(0).norm(); }

 private:
  static constexpr double kDt = 1e-3;

  template <class Lead>
  Felt feel(int ticks, Lead&& lead) {
    Felt felt;
    for (int i = 1; i <= ticks; ++i) {
      lead(static_cast<double>(i) / ticks);
      const Vector3d before = nodes_->force(0);
      tick();
      const double change = (nodes_->force(0) - before).norm();
      felt.most = std::max(felt.most, force());
      felt.jump = std::max(felt.jump, change);
      felt.change += change / ticks;
    }
    return felt;
  }
  void tick() {
    if (ticks_++ % kSampleApart == 0) {
      ToolDofs wanted = tip_at(scene_.tools[0], at_);
      wanted.grip = grip_;
      device_->put({wanted, ++seq_});
    }
    const DeviceSample sample = device_->read(kDt * ticks_);
    dofs_[0] = guard_->follow(sample.dofs, sample.seq);
    nodes_->step(dofs_);
    device_->render({nodes_->force(0), nodes_->haptic().torque(0)}, 0);
  }

  Vector3d at_;
  double grip_ = 0;
  Scene scene_;
  std::unique_ptr<TwoNodes> nodes_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<MotionGuard> guard_;
  std::vector<ToolDofs> dofs_;
  std::uint64_t seq_ = 0;
  int ticks_ = 0;
};

void expect_calm(const HeldExample::Felt& felt, double most, double jump, double change, const char* when) {
  EXPECT_LT(felt.most, most) << when;
  EXPECT_LT(felt.jump, jump) << when;
  EXPECT_LT(felt.change, change) << when;
}

TEST(HeldExample, JawsThatHoldTheLobeDrawItWithoutABuzz) {
  HeldExample lobe("hepatectomy.toml", {0.15, -0.03, 0.07});
  lobe.grip(0.6);
  lobe.stand(0.8);
  lobe.lead({0.113, -0.035, 0.055}, 0.05);
  lobe.stand(0.2);
  lobe.lead({0.112, -0.022, 0.034}, 0.02);
  expect_calm(lobe.stand(1), 0.2, 0.002, 2e-4, "pressed");
  lobe.grip(0);
  expect_calm(lobe.stand(2), 0.2, 0.01, 1e-4, "shut");
  expect_calm(lobe.lead({0.117, -0.012, 0.038}, 0.01), 0.7, 0.02, 0.002, "drawn");
  expect_calm(lobe.stand(1), 0.7, 0.02, 0.001, "held");
  expect_calm(lobe.lead({0.135, 0, 0.05}, 0.02), 2.3, 0.025, 0.003, "drawn farther");
  expect_calm(lobe.stand(2), 2.2, 0.02, 0.001, "held farther");
  EXPECT_GT(lobe.force(), 1.9) << "it draws as hard as it can";
  lobe.grip(0.6);
  EXPECT_LT(lobe.stand(0.5).jump, 0.15) << "what is let go slides out";
  EXPECT_EQ(lobe.force(), 0);
}

TEST(HeldExample, AMouseThatGoesThroughTheDuctPressesItWithoutABuzz) {
  HeldExample duct("duct_poke.toml", {-0.02, -0.02, 0.05});
  duct.stand(0.5);
  for (const auto& [x, y] : {std::pair{-0.02, -0.012}, {-0.03, -0.0158}, {-0.04, -0.01}}) {
    duct.stand_at({x, y, 0.047}, 1);
    expect_calm(duct.stand_at({x, y, -0.052}, 0.6), 2, 0.251, 0.01, "down");
    expect_calm(duct.stand(0.6), 2, 0.251, 0.005, "there");
    duct.stand_at({x, y, 0.043}, 1.2);
    EXPECT_EQ(duct.force(), 0);
  }
}

TEST(HeldExample, AMouseThatSlipsOffTheDuctIsNotLetGoInOneTick) {
  HeldExample duct("duct_poke.toml", {-0.02, -0.02, 0.05});
  duct.stand(0.5);
  duct.stand_at({-0.0105, -0.0158, 0.047}, 1);
  expect_calm(duct.stand_at({-0.0105, -0.0158, -0.052}, 1.2), 4, 0.251, 0.05, "down");
  EXPECT_EQ(duct.force(), 0) << "beside it";
}

/// The tools of an example by their script, which a page takes one of after so long [s], by samples that say where it
/// was a moment before.
HeldExample::Felt taken_from_script(const std::string& name, int tool, double after) {
  constexpr double kDt = 1e-3;
  constexpr int kSeenLate = 30, kSampleApart = 16, kWatched = 1000;  // ticks
  const Scene scene = load_scene(std::string(PALPATE_SOURCE_DIR) + "/scenes/" + name);
  TwoNodes nodes(scene, load_or_precompute(scene, ArchivePart::surface));
  nodes.delay(HeldExample::kLateTicks);
  const auto devices = make_devices(scene.tools, scene.rates.haptic_hz, true);
  std::vector<ToolDofs> dofs;
  for (const auto& device : devices) dofs.push_back(device->read(0).dofs);
  nodes.start(dofs);
  const int taken = static_cast<int>(after / kDt);
  HeldExample::Felt felt;
  DeviceSample sample;
  for (int i = 1; i <= taken + kWatched; ++i) {
    if (i == taken - kSeenLate) sample.dofs = dofs[tool];
    if (i >= taken && (i - taken) % kSampleApart == 0) {
      ++sample.seq;
      devices[tool]->put(sample);
    }
    for (std::size_t t = 0; t < devices.size(); ++t) dofs[t] = devices[t]->read(kDt * i).dofs;
    const Vector3d before = nodes.force(tool);
    nodes.step(dofs);
    for (std::size_t t = 0; t < devices.size(); ++t)
      devices[t]->render({nodes.force(static_cast<int>(t)), nodes.haptic().torque(static_cast<int>(t))}, 0);
    if (i < taken) continue;
    felt.most = std::max(felt.most, nodes.force(tool).norm());
    felt.jump = std::max(felt.jump, (nodes.force(tool) - before).norm());
  }
  return felt;
}

// The forceps carries the lobe that has been cut off, at 51 mm/s.
TEST(HeldExample, JawsThatCarryTheLobeAreTakenFromTheirScriptWithoutAKick) {
  const HeldExample::Felt felt = taken_from_script("hepatectomy.toml", 0, 13.36);
  EXPECT_LT(felt.jump, 0.02);
  EXPECT_LT(felt.most, 0.2);
  EXPECT_GT(felt.most, 0.05) << "it carries it";
}

// A hundred times as stiff as the scene has it, and a thousand.
TEST(HeldExample, AMouseThatIsLedIntoAHardLiverRestsOnIt) {
  for (const char* young : {"600e3", "6e6"}) {
    HeldExample liver("liver.toml", {-0.0297, -0.07, 0.072}, {{"body.young", young}});
    liver.stand(0.3);
    liver.stand_at({-0.028, -0.02, 0.005}, 1.5);
    expect_calm(liver.stand(1), 2 + 1e-6, 1e-5, 1e-5, young);
    EXPECT_NEAR(liver.force(), 2, 1e-6) << young;
  }
}

}  // namespace
}  // namespace palpate
