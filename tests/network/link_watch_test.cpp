#include "common/bus/link_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "common/bus/memory_bus.hpp"

namespace palpate {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

class LinkWatchTest : public ::testing::Test {
 protected:
  /// What the node, which looks each second, is told until a time [s] after its start.
  std::vector<std::string> at(double time) {
    std::vector<std::string> told;
    while (looked_ + 1 < time) std::ranges::copy(after_pause(looked_ + 1), std::back_inserter(told));
    std::ranges::copy(after_pause(time), std::back_inserter(told));
    return told;
  }
  /// The same, where it stood still from its last look on.
  std::vector<std::string> after_pause(double time) {
    looked_ = time;
    own_.watch();
    return link_.look(own_, kStart + static_cast<std::int64_t>(time * kSecond));
  }
  std::string silence(double time) {
    return link_.silence("haptic", kStart + static_cast<std::int64_t>(time * kSecond));
  }

  static constexpr std::int64_t kStart = 1000 * kSecond;
  std::shared_ptr<MemoryNetwork> network_ = make_memory_network();
  std::unique_ptr<Bus> bus_ = make_memory_bus(network_), other_bus_ = make_memory_bus(network_);
  Presence own_{*bus_, "render", 0, "scene", "archive"};
  LinkWatch link_{*bus_};
  double looked_ = 0;  ///< [s]
};

using Said = std::vector<std::string>;

TEST_F(LinkWatchTest, ANodeThatIsAloneSaysOnceWhereItListens) {
  EXPECT_EQ(at(0), Said{});
  EXPECT_EQ(at(4.9), Said{});
  EXPECT_EQ(at(5.1), Said{"alone for 5 s; listening in this process"});
  EXPECT_EQ(at(60), Said{});
  EXPECT_EQ(silence(60), "") << "nobody has fallen silent who never spoke";
}

TEST_F(LinkWatchTest, SilenceAndReturnOfANodeAreTold) {
  Presence haptic(*other_bus_, "haptic", 7, "scene", "archive");
  const std::string name = haptic.node();
  EXPECT_EQ(at(0), Said{});
  EXPECT_EQ(at(2.4), Said{});
  EXPECT_EQ(silence(2.4), "");
  EXPECT_EQ(at(2.6), Said{"nothing from " + name + " for 2.6 s: it has ended, or the network is cut"});
  EXPECT_EQ(silence(4), "nothing from " + name + " for 4 s");
  EXPECT_EQ(at(4), Said{});
  haptic.announce(1000, 1, 0, 0, 0);
  EXPECT_EQ(at(4.5), Said{name + " is back"});
  EXPECT_EQ(silence(4.5), "");
  EXPECT_EQ(at(7.2).size(), 1u) << "silent once more";
  EXPECT_EQ(at(11.4), Said{});
  EXPECT_EQ(at(11.6), Said{"alone for 5 s; listening in this process"});
}

TEST_F(LinkWatchTest, WhileANodeItselfStoodNobodyWasSilent) {
  const Presence haptic(*other_bus_, "haptic", 7, "scene", "archive");
  EXPECT_EQ(at(0.5), Said{});
  EXPECT_EQ(after_pause(6), Said{}) << "what came meanwhile has not been delivered yet";
  EXPECT_EQ(at(7.2), Said{});
  EXPECT_EQ(at(7.4), Said{"nothing from " + haptic.node() + " for 2.6 s: it has ended, or the network is cut"});
}

TEST_F(LinkWatchTest, SilenceIsToldByANodeThatIsAlwaysSlow) {
  const Presence haptic(*other_bus_, "haptic", 7, "scene", "archive");
  EXPECT_EQ(after_pause(3), Said{});
  EXPECT_EQ(after_pause(6), Said{});
  EXPECT_EQ(after_pause(9), Said{});
  EXPECT_EQ(after_pause(12).size(), 1u);
}

}  // namespace
}  // namespace palpate
