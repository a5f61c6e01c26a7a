#include "haptic_node/interventions.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "common/node/pace_watch.hpp"
#include "idl/messages.hpp"

namespace palpate {
namespace {

TEST(Interventions, AreToldOnceAndStandInTheStatusWhileTheyLast) {
  Interventions told;
  told.look({});
  EXPECT_TRUE(told.news().empty());
  EXPECT_EQ(told.status(), "");
  told.look({.flags = stale_model, .refused_samples = 3});
  EXPECT_EQ(told.news().size(), 2u);
  EXPECT_NE(told.status().find("samples of a device are refused"), std::string::npos);
  told.look({.flags = stale_model, .refused_samples = 3});
  EXPECT_TRUE(told.news().empty());
  EXPECT_NE(told.status().find("the force of moving tissue fades"), std::string::npos);
  told.look({.flags = fault | stale_model, .refused_samples = 4});
  EXPECT_EQ(told.news().size(), 1u);
  EXPECT_NE(told.status().find("a fault has taken the force away"), std::string::npos);
  told.look({.refused_samples = 4});
  EXPECT_EQ(told.status(), "");
}

TEST(Interventions, TheLimitsOfThePortAndTheDampingAreToldToo) {
  for (const auto& [flag, words] : {std::pair{force_limited, "more was asked for"},
                                    {slew_limited, "rises no faster"},
                                    {passivity_limited, "more energy than they had put in"},
                                    {silent_device, "driver elsewhere is silent"}}) {
    Interventions told;
    told.look({.flags = flag});
    ASSERT_EQ(told.news().size(), 1u) << words;
    EXPECT_NE(told.news()[0].find(words), std::string::npos) << told.news()[0];
    EXPECT_EQ(told.status(), told.news()[0]);
    told.look({.flags = flag});
    EXPECT_TRUE(told.news().empty()) << words;
  }
}

TEST(PaceWatchTest, ALoopThatFallsBehindTwiceInARowSaysSoOnceAndThatItKeepsUpAgain) {
  PaceWatch pace("the tissue", "its time goes slower");
  std::uint64_t done = 0, missed = 0;
  const auto look = [&](std::uint64_t more, std::uint64_t left_out) { pace.look(done += more, missed += left_out); };
  look(1000, 0);
  look(700, 300);
  EXPECT_EQ(pace.status(), "") << "once may be anything";
  look(960, 40);
  look(700, 300);
  EXPECT_EQ(pace.status(), "");
  look(600, 400);
  EXPECT_EQ(pace.status(), "the tissue falls behind by 40 %: its time goes slower; this machine has too much to do");
  EXPECT_EQ(pace.news(), pace.status());
  EXPECT_EQ(pace.looks_behind(), 1u);
  look(500, 500);
  EXPECT_EQ(pace.looks_behind(), 2u);
  EXPECT_NE(pace.status(), "");
  EXPECT_EQ(pace.news(), "");
  look(990, 10);
  EXPECT_EQ(pace.status(), "");
  EXPECT_EQ(pace.news(), "the tissue keeps up again");
  look(0, 0);
  EXPECT_EQ(pace.news(), "");
}

}  // namespace
}  // namespace palpate
