#include <gtest/gtest.h>

#include <limits>

#include "common/sim/step_messages.hpp"
#include "tests/haptic/block_scene.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kPressed = 200;  // steps

/// A haptic node that comes back into a body, and what a peer keeps of the one before.
class ResumedContacts : public ::testing::Test {
 protected:
  ResumedContacts() {
    before_.start(std::array{pressed(0)});
    for (int i = 0; i <= kPressed; ++i) before_.step(std::array{pressed(i)});
    keep(pressed(kPressed));
    again_.place(std::array{pressed(kPressed)});
  }
  const Tool& tool() const { return block_.scene.tools[0]; }
  /// 6 mm deep at the end of the press, then aside.
  ToolDofs pressed(int i) const {
    const double aside = 5e-5 * std::max(0, i - kPressed);
    return tip_at(tool(), {aside, 0.5 * aside, 0.02 - 9e-5 * std::min(i, kPressed)});
  }
  void keep(const ToolDofs& at) {
    StepRecord record{};
    prepare_record(before_, record);
    fill_record(before_, std::array{DeviceSample{at, 0}}, 1, 0, record);
    describe_contacts(record, 0, kept_);
    held_force_ = before_.force(0);
  }
  /// Nothing of it has been taken.
  void expect_refused(const ContactState& kept) {
    EXPECT_FALSE(again_.resume(kept));
    EXPECT_TRUE(again_.law(0).contacts().empty());
    EXPECT_FALSE(again_.starts_inside().empty());
  }

  testing::BlockScene block_;
  ContactState kept_;
  HapticStep before_{block_.scene, block_.archives}, again_{block_.scene, block_.archives};
  Vector3d held_force_ = Vector3d::Zero();
};

TEST_F(ResumedContacts, ThatAreGoodAreTakenUp) {
  ASSERT_FALSE(kept_.contacts.empty());
  EXPECT_FALSE(again_.starts_inside().empty());
  EXPECT_TRUE(again_.resume(kept_));
  EXPECT_TRUE(again_.starts_inside().empty());
  for (int i = 0; i < 20; ++i) again_.step(std::array{pressed(kPressed)});
  EXPECT_LT((again_.force(0) - held_force_).norm(), 0.02 * held_force_.norm());
}

TEST_F(ResumedContacts, OfAToolThatRubsAreTakenUpAtAnyMoment) {
  for (int i = kPressed + 1; i < kPressed + 400; ++i) {
    before_.step(std::array{pressed(i)});
    if (i % 20 != 0) continue;
    keep(pressed(i));
    HapticStep again(block_.scene, block_.archives);
    again.place(std::array{pressed(i)});
    ASSERT_TRUE(again.resume(kept_)) << i;
    for (int k = 0; k < 20; ++k) {
      again.step(std::array{pressed(i)});
      EXPECT_LT((again.force(0) - held_force_).norm(), 0.5 * held_force_.norm()) << i << ": friction begins anew";
    }
  }
}

// What they were before is not known: they go on as if they had long been so.
TEST_F(ResumedContacts, OfTissueThatRelaxesGoOnRelaxed) {
  for (const ContactRule rule : {ContactRule::barycentric, ContactRule::alpha, ContactRule::patch}) {
    block_.scene.contact.rule = rule;
    as<QuasiStaticSpec>(block_.scene.bodies[0])->relaxation = Relaxation{{0.05, 0.4}, {0.3, 0.25}};
    HapticStep before(block_.scene, block_.archives), again(block_.scene, block_.archives);
    before.start(std::array{pressed(0)});
    for (int i = 0; i <= 3000; ++i) before.step(std::array{pressed(std::min(i, kPressed))});
    StepRecord record{};
    prepare_record(before, record);
    fill_record(before, std::array{DeviceSample{pressed(kPressed), 0}}, 1, 0, record);
    ContactState kept;
    describe_contacts(record, 0, kept);
    again.place(std::array{pressed(kPressed)});
    ASSERT_TRUE(again.resume(kept));
    for (int i = 0; i < 50; ++i) {
      again.step(std::array{pressed(kPressed)});
      ASSERT_NEAR(again.force(0).z(), before.force(0).z(), 0.1 * before.force(0).z()) << i;
    }
  }
}

TEST_F(ResumedContacts, OfATipThatHasLeftAreForgotten) {
  block_.scene.contact.rule = ContactRule::patch;
  block_.scene.passivity.controller = false;
  HapticStep before(block_.scene, block_.archives), again(block_.scene, block_.archives),
      fresh(block_.scene, block_.archives);
  before.start(std::array{pressed(0)});
  for (int i = 0; i <= kPressed + 50; ++i) before.step(std::array{pressed(i)});
  StepRecord record{};
  prepare_record(before, record);
  fill_record(before, std::array{DeviceSample{pressed(kPressed + 50), 0}}, 1, 0, record);
  ContactState kept;
  describe_contacts(record, 0, kept);
  again.place(std::array{pressed(kPressed + 50)});
  ASSERT_TRUE(again.resume(kept));
  fresh.start(std::array{pressed(0)});
  for (int i = 0; i <= kPressed; ++i) {
    again.step(std::array{pressed(i)});
    fresh.step(std::array{pressed(i)});
  }
  EXPECT_GT(fresh.force(0).norm(), 0.1);
  EXPECT_LT((again.force(0) - fresh.force(0)).norm(), 1e-9 * fresh.force(0).norm());
}

TEST_F(ResumedContacts, AreTakenUpOnce) {
  ASSERT_TRUE(again_.resume(kept_));
  const std::size_t taken = again_.law(0).contacts().size();
  EXPECT_TRUE(again_.resume(kept_)) << "another peer keeps them too";
  EXPECT_EQ(again_.law(0).contacts().size(), taken);
}

TEST_F(ResumedContacts, OneThatCannotBeRefusesAll) {
  const auto refused = [&](auto&& change) {
    ContactState kept = kept_;
    change(kept.contacts.back());
    expect_refused(kept);
  };
  for (const std::uint32_t number : {1u, 1u << 31, std::numeric_limits<std::uint32_t>::max()}) {
    refused([&](HeldContact& c) { c.body = number; });
    refused([&](HeldContact& c) { c.sample = number == 1 ? 1000 : number; });
  }
  for (const double size : {1e300, -1e300, 2.0}) refused([&](HeldContact& c) { c.weights[1] = size; });
  refused([](HeldContact& c) { c.weights = {1.5, -0.5, 0}; });
  refused([](HeldContact& c) { c.offset[2] = 0.3; });
  refused([](HeldContact& c) { c.normal = {0, 0, 0}; });
  refused([](HeldContact& c) { c.force[0] = 1e9; });
  const auto nodes = static_cast<std::uint32_t>(block_.archives[0].surface.size());
  for (const std::uint32_t node : {nodes, 100'000u, (1u << 31) - 1, 1u << 31, ~0u})
    refused([&](HeldContact& c) { c.nodes[2] = node; });
  refused([](HeldContact& c) { std::swap(c.nodes[0], c.nodes[1]); });
  refused([&](HeldContact& c) { c.nodes.fill(nodes - 1), c.weights = {1, 0, 0}; });
}

TEST_F(ResumedContacts, OfAnotherToolOrNoneAreRefused) {
  for (const std::uint32_t tool : {1u, 1u << 31}) {
    ContactState kept = kept_;
    kept.tool = tool;
    expect_refused(kept);
  }
  expect_refused({.tool = 0});
}

TEST_F(ResumedContacts, MoreThanTheBodyCanHoldAreRefused) {
  kept_.contacts.resize(TouchBody::kMaxContacts + 1, kept_.contacts[0]);
  expect_refused(kept_);
}

TEST_F(ResumedContacts, FarFromTheToolAreRefused) {
  const SurfaceMap& surface = block_.archives[0].surface;
  const Vector3d tip(0, 0, 0.002);
  for (std::uint32_t node = 0; node < static_cast<std::uint32_t>(surface.touchable); ++node) {
    if ((surface.position[node] - tip).norm() < 0.03) continue;
    ContactState kept = kept_;
    HeldContact& c = kept.contacts.back();
    c.nodes.fill(node), c.weights = {1, 0, 0};
    expect_refused(kept);
  }
}

TEST_F(ResumedContacts, GiveTheForceOfTheirPlacesWhateverIsSaidOfIt) {
  for (HeldContact& c : kept_.contacts) c.force = {70, 0, -70};
  ASSERT_TRUE(again_.resume(kept_));
  for (int i = 0; i < 20; ++i) {
    again_.step(std::array{pressed(kPressed)});
    EXPECT_LT((again_.force(0) - held_force_).norm(), 0.05 * held_force_.norm()) << i;
  }
}

}  // namespace
}  // namespace palpate
