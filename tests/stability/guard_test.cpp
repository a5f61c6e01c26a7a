#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <stdexcept>
#include <system_error>

#include "tools/stability/guarded_run.hpp"

namespace palpate::stability {
namespace {

TEST(StabilityGuard, ACrashAHangAndNonsenseBecomeFailedRows) {
  const auto row = [](auto run, double limit = 5) {
    return run_guarded({.name = "a", .parameter = "b", .value = "c", .run = run, .limit = limit});
  };
  EXPECT_EQ(row([]() -> Result {
              raise(SIGKILL);
              return {};
            }).outcome,
            "failed");
  EXPECT_EQ(row(
                []() -> Result {
                  for (;;) usleep(1000);
                },
                0.2)
                .outcome,
            "failed");
  EXPECT_EQ(row([]() -> Result { return {.max_force = NAN}; }).outcome, "failed");
  EXPECT_EQ(row([]() -> Result { return {.energy_growth = INFINITY}; }).outcome, "failed");
  EXPECT_EQ(row([]() -> Result { throw std::logic_error("no"); }).outcome, "failed");
  EXPECT_EQ(row([]() -> Result { throw std::system_error(ENOSPC, std::generic_category()); }).outcome, "failed")
      << "no refusal of the product's";
  const Row refused = row([]() -> Result { throw std::runtime_error("the bound is 3"); });
  EXPECT_EQ(refused.outcome, "refused");
  EXPECT_EQ(refused.note, "the bound is 3");
  const Row good = row([]() -> Result {
    return {.outcome = Outcome::regularised, .max_force = 1.5, .energy_growth = -2, .note = "a, \"b\""};
  });
  EXPECT_EQ(good.outcome, "regularised");
  EXPECT_EQ(good.max_force, 1.5);
  EXPECT_EQ(good.note, "a, \"b\"");
}

TEST(StabilityGuard, TheLargerOfTwoIsNoNumberAsSoonAsOneIsNone) {
  EXPECT_EQ(larger(1, 2), 2);
  EXPECT_EQ(larger(2, 1), 2);
  EXPECT_TRUE(std::isnan(larger(NAN, 1)));
  EXPECT_TRUE(std::isnan(larger(1, NAN)));
}

}  // namespace
}  // namespace palpate::stability
