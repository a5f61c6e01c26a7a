#include <gtest/gtest.h>

#include <limits>

#include "common/sim/step_messages.hpp"
#include "tests/haptic/block_scene.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// A haptic node that comes back into the block, and what a peer keeps of the one before.
class ResumedContacts : public ::testing::Test {
 protected:
  ResumedContacts() {
    HapticStep before(block_.scene, block_.archives);
    before.start(std::array{tip_at(tool(), {0, 0, 0.02})});
    for (int i = 0; i <= 200; ++i) before.step(std::array{pressed(i)});
    held_force_ = before.force(0).norm();
    StepRecord record{};
    prepare_record(before, record);
    fill_record(before, std::array{DeviceSample{pressed(200), 0}}, 200, 0, record);
    describe_contacts(record, 0, kept_);
    again_.start(std::array{pressed(200)}, true);
  }
  const Tool& tool() const { return block_.scene.tools[0]; }
  ToolDofs pressed(int i) const { return tip_at(tool(), {0, 0, 0.02 - 8e-5 * i}); }

  testing::BlockScene block_;
  ContactState kept_;
  HapticStep again_{block_.scene, block_.archives};
  double held_force_ = 0;
};

TEST_F(ResumedContacts, ThatAreGoodAreTakenUp) {
  ASSERT_FALSE(kept_.contacts.empty());
  for (const HeldContact& held : kept_.contacts) {
    EXPECT_TRUE(again_.fits(0, held));
    again_.adopt(0, held);
  }
  for (int i = 0; i < 20; ++i) again_.step(std::array{pressed(200)});
  EXPECT_NEAR(again_.force(0).norm(), held_force_, 0.02 * held_force_);
}

TEST_F(ResumedContacts, ThatCannotBeAreRefused) {
  const auto refused = [&](std::uint32_t with_tool, auto&& change) {
    HeldContact held = kept_.contacts.at(0);
    change(held);
    EXPECT_FALSE(again_.fits(with_tool, held));
    EXPECT_THROW(again_.adopt(with_tool, held), std::runtime_error);
  };
  refused(1, [](HeldContact&) {});
  refused(1u << 31, [](HeldContact&) {});
  for (const std::uint32_t number : {1u, 1u << 31, std::numeric_limits<std::uint32_t>::max()}) {
    refused(0, [&](HeldContact& c) { c.body = number; });
    refused(0, [&](HeldContact& c) { c.sample = number == 1 ? 1000 : number; });
  }
  for (const double size : {1e300, -1e300, 2.0}) refused(0, [&](HeldContact& c) { c.weights[1] = size; });
  refused(0, [](HeldContact& c) { c.weights = {1.5, -0.5, 0}; });
  refused(0, [](HeldContact& c) { c.offset[2] = 0.3; });
  refused(0, [](HeldContact& c) { c.force[0] = 1e9; });
  for (const std::uint32_t node : {1u << 31, std::numeric_limits<std::uint32_t>::max()})
    refused(0, [&](HeldContact& c) { c.nodes[1] = node; });
  for (const std::uint32_t node : {100'000u, (1u << 31) - 1}) {
    HeldContact held = kept_.contacts.at(0);
    held.nodes[2] = node;
    EXPECT_THROW(again_.adopt(0, held), std::runtime_error) << node;
  }
}

TEST_F(ResumedContacts, AreNoMoreThanTheBodyCanHold) {
  int taken = 0;
  try {
    for (; taken < 4096; ++taken) again_.adopt(0, kept_.contacts.at(0));
  } catch (const std::runtime_error&) {
  }
  EXPECT_LE(taken, TouchBody::kMaxContacts);
  again_.step(std::array{pressed(200)});
  EXPECT_TRUE(again_.force(0).allFinite());
}

}  // namespace
}  // namespace palpate
