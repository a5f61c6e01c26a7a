#include "common/bus/link_watch.hpp"

#include <gtest/gtest.h>

#include "common/bus/memory_bus.hpp"

namespace palpate {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

class LinkWatchTest : public ::testing::Test {
 protected:
  /// What the node is told at a time [s] after its start.
  std::vector<std::string> at(double time) {
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
  EXPECT_EQ(at(9.9), Said{"alone for 5 s; listening in this process"});
}

}  // namespace
}  // namespace palpate
