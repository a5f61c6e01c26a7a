#include "haptic_node/local_feed.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "common/bus/memory_bus.hpp"
#include "tests/haptic/local_models_for_tests.hpp"

namespace palpate {
namespace {

constexpr double kTip = 0.008;  // [m] of the tip's radius
constexpr std::uint64_t kRun = 5, kDeformRun = 77;

/// A haptic step in free air that is told of tissue over the bus.
class ToldOverTheBus : public ::testing::Test {
 protected:
  ToldOverTheBus() : feed_(*bus_, haptic_, kRun), models_(bus_->writer(topics::local_contact_model)) {
    haptic_.start(std::array{free_air()});
    feed_.follow(kDeformRun);
  }

  ToolDofs free_air() const { return tip_at(scene_.tools[0], {0, 0, 0.05}); }
  /// [N] after `steps` more steps, the largest.
  double feel(int steps) {
    double largest = 0;
    for (int k = 0; k < steps; ++k) {
      feed_.take();
      feed_.give(haptic_);
      haptic_.step(std::array{free_air()});
      largest = std::max(largest, haptic_.force(0).norm());
    }
    return largest;
  }
  /// A model that presses the tool by 10 N where it is.
  LocalContactModel press(std::uint64_t step, std::uint64_t seq) const {
    LocalContactModel m = testing::empty_model(scene_.tools[0], {0, 0, 0.05}, step, seq);
    m.tool_run = kRun;
    m.run = kDeformRun;
    testing::add_contact(m, {0, 0, 0.042}, {0, 0, -10}, 0);
    return m;
  }

  Scene scene_ = testing::moving_block_scene(kTip);
  HapticStep haptic_{scene_, std::vector<Archive>(1)};
  std::unique_ptr<Bus> bus_ = make_memory_bus(make_memory_network());
  LocalFeed feed_;
  std::unique_ptr<Writer<LocalContactModel>> models_;
};

TEST_F(ToldOverTheBus, TheNewestModelOfThisRunComesToTheStep) {
  ASSERT_TRUE(feed_.needed());
  EXPECT_EQ(models_->readers(), 1);
  const auto send = [&](std::uint64_t tool_run, std::uint64_t seq) {
    LocalContactModel m = press(0, seq);
    m.tool_run = tool_run;
    m.contacts[0].force = {0, 0, -static_cast<double>(seq)};
    ASSERT_TRUE(models_->write(m));
    feed_.take();
    feed_.give(haptic_);
  };
  feel(1);  // step 0, whose pose the models have
  EXPECT_EQ(haptic_.local(0).model().seq, 0u);
  send(kRun, 1);
  send(kRun, 2);
  EXPECT_EQ(haptic_.local(0).model().seq, 2u);
  send(kRun + 1, 3);
  EXPECT_EQ(haptic_.local(0).model().seq, 2u) << "a model for another haptic run";
  send(kRun, 4);
  EXPECT_EQ(haptic_.local(0).model().seq, 4u);
  feel(60);
  EXPECT_NEAR(haptic_.force(0).z(), 4, 1e-12);
}

TEST(LocalFeed, OfASceneWithoutMovingTissueSubscribesToNothing) {
  const testing::BlockScene still;
  HapticStep haptic(still.scene, still.archives);
  const auto bus = make_memory_bus(make_memory_network());
  LocalFeed feed(*bus, haptic, kRun);
  EXPECT_FALSE(feed.needed());
  EXPECT_EQ(bus->writer(topics::local_contact_model)->readers(), 0);
  feed.give(haptic);
}

TEST_F(ToldOverTheBus, AModelOfADoneStepIsFeltAndAgesWhenNoOtherComes) {
  feel(10);
  models_->write(press(9, 1));
  EXPECT_NEAR(feel(100), 10, 1e-9);
  feel(200);
  EXPECT_EQ(feel(1), 0);
  EXPECT_EQ(feed_.refused(), 0);
}

// It would be young for ever, and its sender need not be there any more.
TEST_F(ToldOverTheBus, AModelOfAStepToComeIsRefused) {
  feel(10);
  std::uint64_t seq = 0;
  for (const std::uint64_t step :
       {std::uint64_t{10}, std::uint64_t{1} << 40, std::numeric_limits<std::uint64_t>::max()}) {
    models_->write(press(step, ++seq));
    EXPECT_EQ(feel(1), 0) << step;
  }
  EXPECT_EQ(feel(500), 0);
  EXPECT_GE(feed_.refused(), 3);
  models_->write(press(510, ++seq));
  EXPECT_NEAR(feel(60), 10, 1e-9) << "the next good one is felt";
}

TEST_F(ToldOverTheBus, AModelOfAStrangerIsPassedOver) {
  feel(10);
  LocalContactModel m = press(9, 1);
  m.run = kDeformRun + 1;
  models_->write(m);
  EXPECT_EQ(feel(100), 0);
}

}  // namespace
}  // namespace palpate
