#include "tools/drive/expectation.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace palpate::drive {
namespace {

const Figures kFigures{{"tool.probe.force.max", 2.5, "N"},
                       {"tool.scalpel.force.max", 4, "N"},
                       {"body.liver.pieces", 2, "1"},
                       {"seconds", 1, "s"}};

std::string why_not(const std::string& text) {
  return disappointment(parse_expectation(text), kFigures);
}

TEST(Expectation, HoldsOrSaysWhyNot) {
  for (const char* good : {"tool.probe.force.max<3", "tool.probe.force.max <= 2.5", " body.liver.pieces==2 ",
                           "seconds!=2", "seconds>0.5", "seconds>=1e0"})
    EXPECT_EQ(why_not(good), "") << good;
  EXPECT_EQ(why_not("tool.probe.force.max<2.5"), "tool.probe.force.max is 2.5 N, expected <2.5");
  EXPECT_EQ(why_not("body.liver.pieces==1"), "body.liver.pieces is 2, expected ==1");
  EXPECT_NE(why_not("seconds<=0.5"), "");
  EXPECT_NE(why_not("seconds!=1"), "");
  EXPECT_NE(why_not("seconds>1"), "");
  EXPECT_NE(why_not("seconds>=2"), "");
}

TEST(Expectation, WithoutANameIsOfTheLargest) {
  EXPECT_EQ(why_not("tool.force.max<3"), "tool.scalpel.force.max is 4 N, expected <3");
  EXPECT_EQ(why_not("body.pieces==2"), "");
}

TEST(Expectation, IsNeverMetByWhatIsNoNumber) {
  const Figures broken{{"tool.probe.force.max", 1, "N"},
                       {"tool.other.force.max", std::numeric_limits<double>::quiet_NaN(), "N"}};
  for (const char* sign : {"<", "<=", ">", ">=", "==", "!="})
    EXPECT_NE(disappointment(parse_expectation(std::string("tool.force.max") + sign + "3"), broken), "") << sign;
}

TEST(Expectation, ThatSaysNothingIsRefused) {
  for (const char* bad : {"", "tool.force.max", "<3", "seconds<", "seconds<x", "seconds<3x", "seconds<nan", "seconds=1",
                          "seconds<inf", "seconds!1"})
    EXPECT_THROW(parse_expectation(bad), std::runtime_error) << bad;
  try {
    why_not("tool.probe.force.mex<3");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "--expect: a run of this scene has no figure 'tool.probe.force.mex'; did you mean "
                 "'tool.probe.force.max'?");
  }
}

}  // namespace
}  // namespace palpate::drive
