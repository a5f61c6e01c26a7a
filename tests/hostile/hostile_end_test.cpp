// How the attacked nodes end; the last of the cases.
#include "tests/hostile/hostile.hpp"

namespace palpate::testing {
namespace {

constexpr double kMinHzOfAll = 990;  // while the machine runs: little may fall out in all

TEST_P(Hostile, NodesEndAsTheyShouldAndSayWhatTheyRefused) {
  std::map<std::string, nlohmann::json> said = system().end();
  ended_ = true;
  for (const char* name : {"deform", "render", "web", "haptic"}) ASSERT_TRUE(said.contains(name)) << name;
  EXPECT_GT(said["haptic"].value("refused_messages", 0), 0);
  EXPECT_GT(said["haptic"].value("implausible_models", 0) + said["haptic"].value("implausible_force_steps", 0), 0);
  EXPECT_GE(rate_hz(said["haptic"]), kMinHzOfAll);
  EXPECT_EQ(said["haptic"].value("dropped", -1), 0) << "steps that the log would lack";
  EXPECT_GT(said["deform"].value("refused", 0), 0);
  EXPECT_GT(said["render"].value("refused", 0), 0);
  EXPECT_GT(said["web"].value("refused_messages", 0), 0);
}

INSTANTIATE_TEST_SUITE_P(Open, Hostile, ::testing::Values(false));
INSTANTIATE_TEST_SUITE_P(WithKeys, Hostile, ::testing::Values(true));

}  // namespace
}  // namespace palpate::testing
