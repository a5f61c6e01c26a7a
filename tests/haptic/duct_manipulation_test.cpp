// Forceps, catheter and duct together, as the haptic step moves them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

#include "common/models/catheter/catheter_part.hpp"
#include "common/models/modal_shell/modal_body.hpp"
#include "common/models/modal_shell/modal_shape.hpp"
#include "tests/haptic/duct_scene.hpp"
#include "tests/sanitized.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::duct_tip_at;
using testing::DuctScene;
using testing::kSanitized;

constexpr double kWideOpen = 0.8;

/// The wall as the deformation node shows it: all nodes, those too that the haptic step has no need of.
class ShownWall {
 public:
  explicit ShownWall(const Archive& archive) : rest_(archive.surface.position), shape_(archive) {
    state_.coordinates.resize(shape_.modes());
  }
  const std::vector<Vector3d>& of(const ModalBody& duct) {
    state_.forces.clear();
    duct.show(state_.coordinates.data(), [&](int node, const Vector3d& f) {
      state_.forces.push_back({static_cast<std::uint32_t>(node),
                               {static_cast<float>(f[0]), static_cast<float>(f[1]), static_cast<float>(f[2])}});
    });
    shape_.displace(state_, displacement_);
    nodes_ = rest_;
    for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_[n] += displacement_[n].cast<double>();
    return nodes_;
  }

 private:
  const std::vector<Vector3d> rest_;
  ModalShape shape_;
  ModalState state_;
  std::vector<Eigen::Vector3f> displacement_;
  std::vector<Vector3d> nodes_;
};

/// Solid angle of the tube, mouths closed by fans, around p over 4 pi: 1 inside, 0 outside.
double winding(const ModalBody& duct, const std::vector<Vector3d>& x, const Vector3d& p) {
  double sum = 0;
  const auto add = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const Vector3d u = a - p, v = b - p, w = c - p;
    const double lu = u.norm(), lv = v.norm(), lw = w.norm();
    sum += 2 * std::atan2(u.dot(v.cross(w)), lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv);
  };
  for (int t = 0; t < duct.surface().triangle_count(); ++t) {
    const auto& n = duct.surface().triangle(t);
    add(x[n[0]], x[n[1]], x[n[2]]);
  }
  for (const auto& loop : duct.mouths()) {
    Vector3d centre = Vector3d::Zero();
    for (int n : loop) centre += x[n] / static_cast<double>(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i) add(x[loop[(i + 1) % loop.size()]], x[loop[i]], centre);
  }
  return sum / (4 * std::numbers::pi);
}

/// [m] from p to the fans that close the mouths.
double from_mouths(const ModalBody& duct, const std::vector<Vector3d>& x, const Vector3d& p) {
  double squared = 1;
  for (const auto& loop : duct.mouths()) {
    Vector3d centre = Vector3d::Zero();
    for (int n : loop) centre += x[n] / static_cast<double>(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i)
      squared =
          std::min(squared, closest_point(p, {centre, x[loop[i]], x[loop[(i + 1) % loop.size()]]}).squared_distance);
  }
  return std::sqrt(squared);
}

/// A catheter before the mouth of a duct and a forceps on either.
struct Theatre {
  DuctScene duct;
  std::vector<ToolDofs> dofs;
  std::unique_ptr<HapticStep> haptic;

  explicit Theatre(int modes = 30, double catheter_young = 30e6) : duct(modes) {
    duct.add_catheter();
    as<CatheterSpec>(duct.scene.bodies[1])->material.young = catheter_young;
    duct.add_forceps().pivot = {0, 0.15, -0.03};
    TurningJaws& long_jaws = std::get<ForcepsSpec>(duct.add_forceps().end).jaws;
    long_jaws.length = 0.02;
    long_jaws.max_open = 1.6;
    haptic = std::make_unique<HapticStep>(duct.scene, duct.archives);
    dofs = {at(0, {0, 0.03, -0.02}, kWideOpen), at(1, {0, 0.03, 0.02}, kWideOpen)};
    haptic->start(dofs);
  }
  ToolDofs at(int tool, const Vector3d& joint, double grip) const {
    return duct_tip_at(duct.scene.tools[tool], joint, grip, std::numbers::pi / 2);
  }
  void hold_still(int steps) {
    for (int i = 0; i < steps; ++i) haptic->step(dofs);
  }
  void move(int tool, const Vector3d& from, const Vector3d& to, double grip, int steps) {
    for (int i = 1; i <= steps; ++i) {
      dofs[tool] = at(tool, from + (to - from) * i / steps, grip);
      haptic->step(dofs);
    }
  }
  void close(int tool, const Vector3d& joint, double from, double to, int steps) {
    for (int i = 1; i <= steps; ++i) {
      dofs[tool] = at(tool, joint, from + (to - from) * i / steps);
      haptic->step(dofs);
    }
  }
  const CatheterPart& guest() const { return dynamic_cast<const CatheterPart&>(*haptic->part(1)); }
  const CatheterBody& catheter() const { return guest().body(); }
  const ModalBody& wall() const { return dynamic_cast<const ModalBody&>(*haptic->part(0)); }
  const Task& task() const { return guest().task(); }

  /// The feeding stroke: comes down on the catheter 20 mm before the mouth, takes it, and leads it in by 15 mm.
  void feed() {
    const Vector3d above{0, 0.03, -0.02}, on{0, 0.008, -0.02}, ahead{0, 0.008, -0.005};
    move(0, above, on, kWideOpen, 200);
    close(0, on, kWideOpen, 0.1, 200);
    move(0, on, ahead, 0.1, 300);
    hold_still(100);
  }
};

TEST(DuctManipulation, JawsStopAtTheCatheterTakeItAndFeelIt) {
  Theatre t;
  const Vector3d above{0, 0.03, -0.02}, on{0, 0.008, -0.02};
  t.move(0, above, on, kWideOpen, 200);
  EXPECT_FALSE(t.catheter().holds(0));
  t.close(0, on, kWideOpen, 0.1, 200);
  EXPECT_TRUE(t.catheter().holds(0));
  EXPECT_EQ(t.task().grasps, 1u);
  // 1.25 mm of catheter and 1 mm of jaw on either side, about 8 mm ahead of the joint.
  EXPECT_NEAR(t.haptic->opening(0), 2 * std::asin(0.00225 / 0.008), 0.1);
  EXPECT_NEAR(t.haptic->grip_torque(0), 0.5 * (t.haptic->opening(0) - 0.1), 1e-9);
  EXPECT_EQ(t.haptic->grip_torque(1), 0);
}

// A scene may give the linkage any stiffness.
TEST(DuctManipulation, AHardLinkageGivesTheHandleNoMoreThanTheHandMayFeel) {
  Theatre t;
  Tool& tool = t.duct.scene.tools[0];
  std::get<ForcepsSpec>(tool.end).jaws.grip_stiffness = 1000;
  t.haptic = std::make_unique<HapticStep>(t.duct.scene, t.duct.archives);
  t.haptic->start(t.dofs);
  const Vector3d above{0, 0.03, -0.02}, on{0, 0.008, -0.02};
  t.move(0, above, on, kWideOpen, 200);
  const double most = tool.max_force * SafetyChain::kHandleLever;
  const double by = tool.max_force_rate * t.haptic->dt() * SafetyChain::kHandleLever;
  double last = 0, largest = 0, change = 0;
  const auto look = [&] {
    largest = std::max(largest, t.haptic->grip_torque(0));
    change = std::max(change, std::abs(t.haptic->grip_torque(0) - last));
    last = t.haptic->grip_torque(0);
  };
  for (int i = 1; i <= 200; ++i) t.close(0, on, kWideOpen - 0.0035 * (i - 1), kWideOpen - 0.0035 * i, 1), look();
  EXPECT_NEAR(largest, most, 1e-9);
  t.haptic->trip();
  for (int i = 0; i < 5; ++i) t.hold_still(1);
  EXPECT_LT(t.haptic->grip_torque(0), 1e-9) << "after a fault";
  EXPECT_LE(change, by + 1e-12);
}

TEST(DuctManipulation, AGraspedCatheterIsLedInAndPushesBack) {
  Theatre t;
  t.feed();
  EXPECT_GT(t.task().inserted, 0.009);
  EXPECT_LT(t.task().inserted, 0.013);
  EXPECT_EQ(t.task().drops, 0u);
  EXPECT_GT(t.task().held_s, 0.4);
  t.move(0, {0, 0.008, -0.005}, {0, 0.008, -0.02}, 0.1, 300);  // and withdrawn
  EXPECT_LT(t.task().inserted, 0.001);
  EXPECT_GT(t.task().deepest, 0.009);
}

TEST(DuctManipulation, OpenedJawsLetGo) {
  Theatre t;
  t.feed();
  t.close(0, {0, 0.008, -0.005}, 0.1, kWideOpen, 100);
  EXPECT_FALSE(t.catheter().holds(0));
  EXPECT_EQ(t.task().drops, 0u);
  EXPECT_EQ(t.haptic->grip_torque(0), 0);
}

TEST(DuctManipulation, PulledHarderThanTheJawsCanHoldItSlipsAndCountsAsADrop) {
  Theatre t;
  std::get<ForcepsSpec>(t.duct.scene.tools[0].end).jaws.friction = 0.05;
  t.haptic = std::make_unique<HapticStep>(t.duct.scene, t.duct.archives);
  t.haptic->start(t.dofs);
  t.feed();
  t.move(0, {0, 0.008, -0.005}, {0, 0.06, -0.005}, 0.1, 400);  // far aside of the sleeve
  EXPECT_EQ(t.task().drops, 1u);
  EXPECT_FALSE(t.catheter().holds(0));
}

TEST(DuctManipulation, TheDuctIsTakenPulledAndLetGo) {
  Theatre t;
  constexpr double wide = 1.5;
  const Vector3d above{0, 0.03, 0.02}, on{0, 0.014, 0.02}, lifted{0, 0.016, 0.02};
  t.close(1, above, kWideOpen, wide, 100);
  t.move(1, above, on, wide, 200);
  EXPECT_EQ(t.haptic->force(1).norm(), 0);  // astride of it
  t.close(1, on, wide, 0.1, 300);
  int held = 0;
  for (const TouchContact& c : t.wall().law().contacts()) held += c.grasped;
  EXPECT_GT(held, 0);
  t.hold_still(300);
  t.move(1, on, lifted, 0.1, 200);
  t.hold_still(500);
  EXPECT_LT(t.haptic->force(1).y(), -0.01);  // it pulls the tool down
  t.close(1, lifted, 0.1, wide, 200);
  t.hold_still(2000);
  held = 0;
  for (const TouchContact& c : t.wall().law().contacts()) held += c.grasped;
  EXPECT_EQ(held, 0);
}

TEST(DuctManipulation, TheCatheterPushesTheWallAsTheWallPushesIt) {
  // Bent aside by the forceps, the catheter leans on the wall: what it does to the duct is what moves the duct.
  Theatre t;
  t.feed();
  t.move(0, {0, 0.008, -0.005}, {0.004, 0.008, -0.005}, 0.1, 300);
  t.hold_still(1500);
  Vector3d on_wall = Vector3d::Zero();
  for (const WallForce& w : t.catheter().wall_forces()) on_wall += w.force;
  EXPECT_GT(on_wall.norm(), 1e-3);
  EXPECT_GT(t.wall().energy(), 0);
  EXPECT_GT(t.haptic->force(0).norm(), 1e-3);
}

TEST(DuctManipulation, TheStepAllocatesNothing) {
  Theatre t;
  t.feed();
  const long before = allocations();
  t.move(0, {0, 0.008, -0.005}, {0.003, 0.009, -0.012}, 0.1, 200);
  t.close(0, {0.003, 0.009, -0.012}, 0.1, kWideOpen, 50);
  EXPECT_EQ(allocations() - before, 0);
}

TEST(DuctManipulation, ARestoredStateGoesOnBitForBit) {
  Theatre a, b;
  a.feed();
  std::vector<std::uint8_t> state(a.haptic->state_size());
  a.haptic->save(state);
  b.haptic->restore(state);
  b.dofs = a.dofs;
  for (Theatre* t : {&a, &b}) t->move(0, {0, 0.008, -0.005}, {0.003, 0.010, -0.002}, 0.1, 150);
  EXPECT_EQ(a.haptic->force(0), b.haptic->force(0));
  EXPECT_EQ(a.haptic->force(1), b.haptic->force(1));
  for (int i = 0; i < a.catheter().size(); ++i) ASSERT_EQ(a.catheter().positions()[i], b.catheter().positions()[i]);
  EXPECT_EQ(a.task().wall_contacts, b.task().wall_contacts);
}

/// Two forceps at all rates, in hands with the mass, damping and stiffness of a person's. One takes the catheter
/// wherever it is and leads or throws it about, mostly towards the duct; the other goes where chance sends it above the
/// duct, and grasps and lets go.
class RandomHands {
 public:
  explicit RandomHands(unsigned seed) : random_(seed) {}

  void step(Theatre& t) {
    for (int tool = 0; tool < 2; ++tool) {
      Hand& h = hands_[tool];
      if (h.left-- <= 0) tool == 0 ? lead(h, t) : wander(h);
      h.goal += (h.to - h.goal) * h.rate;
      h.velocity += kDt / kMass * (kStiffness * (h.goal - h.at) - kDamping * h.velocity + t.haptic->force(tool));
      h.at += kDt * h.velocity;
      h.grip += (h.grip_to - h.grip) * h.rate;
      t.dofs[tool] = t.at(tool, h.at, h.grip);
    }
    t.haptic->step(t.dofs);
  }

 private:
  static constexpr double kDt = 1e-3, kMass = 0.2, kDamping = 15, kStiffness = 400;  ///< [s], [kg], [N s/m], [N/m]
  struct Hand {
    Vector3d at, to, goal = at, velocity = Vector3d::Zero();
    double grip = kWideOpen, grip_to = kWideOpen, rate = 0.01;
    int left = 0, phase = 0;
  };
  double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  void at_any_rate(Hand& h) {
    h.rate = std::exp(within(std::log(2e-3), std::log(0.5)));
    h.left = static_cast<int>(3 / h.rate) + 150;
  }

  void lead(Hand& h, const Theatre& t) {
    at_any_rate(h);
    switch (h.phase++ % 4) {
      case 0:  // to some place of the catheter that lies before the duct, with open jaws
        h.grip_to = kWideOpen;
        h.to = t.catheter().positions()[static_cast<std::size_t>(within(8, 26))] + Vector3d(0, 0.008, 0);
        h.to.z() = std::min(h.to.z(), -0.004);
        break;
      case 1:
        h.grip_to = 0.05;
        break;
      case 2:
        h.to += within(0, 1) < 0.8 ? Vector3d(within(-1e-3, 1e-3), within(-1e-3, 1e-3), within(0, 0.025))
                                   : Vector3d(within(-0.02, 0.02), within(-0.02, 0.02), within(-0.03, 0.03));
        h.to = h.to.cwiseMax(Vector3d(-0.02, 0.004, -0.05)).cwiseMin(Vector3d(0.02, 0.03, -0.004));  // before the duct
        break;
      default:
        h.grip_to = kWideOpen;
    }
  }
  void wander(Hand& h) {
    at_any_rate(h);
    h.grip_to = within(0, 1) < 0.5 ? 0.05 : kWideOpen;
    h.to = {within(-0.012, 0.012), within(0.022, 0.04), within(0.002, 0.035)};
  }

  std::mt19937 random_;
  std::array<Hand, 2> hands_{Hand{.at = {0, 0.03, -0.02}, .to = {0, 0.03, -0.02}},
                             Hand{.at = {0, 0.03, 0.02}, .to = {0, 0.03, 0.02}}};
};

TEST(DuctManipulation, RandomManipulationEndsFiniteBoundedAndInsideTheWall) {
  const bool whole = std::getenv("PALPATE_LONG_TESTS") != nullptr;
  const int steps = whole ? 3'600'000 : kSanitized ? 6'000 : 30'000;
  Theatre t(20);
  for (Tool& tool : t.duct.scene.tools)
    std::get<ForcepsSpec>(tool.end).jaws.grip_stiffness = 0.1;  // as in the example scenes; harder pulls slip
  // Skin and blood hold it: a flick does not send it across the room.
  as<CatheterSpec>(t.duct.scene.bodies[1])->catheter.damping = 100;
  t.haptic = std::make_unique<HapticStep>(t.duct.scene, t.duct.archives);
  t.haptic->start(t.dofs);
  t.feed();
  ShownWall wall(t.duct.archives[0]);
  RandomHands hands(7);
  double max_energy = 0, max_force = 0;
  // Jaws that pinch the duct flat may snap its wall across the catheter's tip within a tick: the chain is stretched
  // then, and hands do not feel it.
  constexpr double kStretched = 0.1;                           // [J]
  int stretched = 0;                                           // [ticks]
  int looks = 0, inside_checks = 0, outside = 0, strayed = 0;  // led in and outside the wall; not led in and within it
  std::vector<char> wrong(t.catheter().size(), false);         // at the last look
  for (int i = 0; i < steps; ++i) {
    hands.step(t);
    ASSERT_TRUE(t.haptic->force(0).allFinite() && t.haptic->force(1).allFinite()) << "step " << i;
    ASSERT_EQ((t.haptic->flags(0) | t.haptic->flags(1)) & fault, 0u) << "step " << i;
    const double energy = t.catheter().energy() + t.wall().energy();
    max_energy = std::max(max_energy, energy);
    stretched += energy > kStretched;
    max_force = std::max({max_force, t.haptic->force(0).norm(), t.haptic->force(1).norm()});
    // A particle is led by the wall as it was when the tick began, and shown beside the wall as it is at the end: one
    // that passes a mouth at 0.7 m/s is a tick apart. It is on the wrong side when it still is a tick later.
    if (i % 50 > 1) continue;
    const std::vector<Vector3d>& nodes = wall.of(t.wall());
    for (int p = 0; p < t.catheter().size(); ++p) {
      if (i % 50 == 1 && !wrong[p]) continue;
      if (from_mouths(t.wall(), nodes, t.catheter().positions()[p]) < t.catheter().radius()) {
        wrong[p] = false;  // half in, half out
        continue;
      }
      const bool inside = winding(t.wall(), nodes, t.catheter().positions()[p]) > 0.5;
      const bool led_in = t.catheter().inside()[p] != 0;
      if (i % 50 == 1) {
        outside += led_in && !inside;
        strayed += inside && !led_in;
        continue;
      }
      ++looks;
      inside_checks += inside;
      wrong[p] = inside != led_in;
    }
  }
  RecordProperty("max_energy_J", std::to_string(max_energy));
  RecordProperty("max_force_N", std::to_string(max_force));
  std::printf(
      "%d s: largest energy %.3g J, %d ticks above 0.1 J, largest force %.3g N, %d grasps, %d drops; of %d looks at a "
      "particle %d find it "
      "inside, %d outside "
      "the wall that it was led into, %d within the wall that it was not led into\n",
      steps / 1000, max_energy, stretched, max_force, static_cast<int>(t.task().grasps),
      static_cast<int>(t.task().drops), looks, inside_checks, outside, strayed);
  EXPECT_LT(max_energy, whole ? 1 : kStretched);
  EXPECT_LT(stretched, 50);
  EXPECT_LT(max_force, 60);
  EXPECT_GT(t.task().grasps, static_cast<std::uint64_t>(steps / 10000));
  EXPECT_GT(t.task().drops, 0u);
  EXPECT_GT(inside_checks, 0);
  EXPECT_EQ(outside, 0);
  EXPECT_EQ(strayed, 0);
}

}  // namespace
}  // namespace palpate
