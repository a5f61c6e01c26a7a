#include "tools/hold_argument.hpp"

#include <gtest/gtest.h>

namespace palpate {
namespace {

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(HoldArgument, ReadsThreeComponents) {
  const auto holds = parse_hold("12:0.001,-2e-3,+0");
  ASSERT_EQ(holds.size(), 3u);
  EXPECT_EQ(holds[1].terms[0].node, 12);
  EXPECT_EQ(holds[1].terms[0].axis, 1);
  EXPECT_EQ(holds[1].value, -2e-3);
  EXPECT_EQ(holds[2].value, 0);
}

TEST(HoldArgument, LeavesAnEmptyComponentFree) {
  const auto holds = parse_hold("7:0.001,,0.002");
  ASSERT_EQ(holds.size(), 2u);
  EXPECT_EQ(holds[0].terms[0].axis, 0);
  EXPECT_EQ(holds[1].terms[0].axis, 2);
}

TEST(HoldArgument, RefusesWhatIsNotANumber) {
  for (const char* text : {"7:a,0,0", "7:1,2", "7:1,2,3,4", "7", "x:1,2,3", "7.5:1,2,3", "7:nan,0,0", "7:0,inf,0",
                           "7:1e999,0,0", "7:1m,0,0", ":1,2,3", "7:1:2,3,4", "", "7:,,"})
    EXPECT_NE(refusal([&] { parse_hold(text); }).find("--hold"), std::string::npos) << text;
}

TEST(HoldArgument, RefusesANodeOutsideTheMesh) {
  EXPECT_NE(refusal([] { parse_holds({"10:1,1,1"}, 10); }).find("node 10 is not in the mesh"), std::string::npos);
  EXPECT_NE(refusal([] { parse_holds({"-1:1,1,1"}, 10); }).find("node -1 is not in the mesh"), std::string::npos);
}

TEST(HoldArgument, RefusesAnAxisHeldTwice) {
  EXPECT_NE(refusal([] {
              parse_holds({"3:1,,1", "3:,1,2"}, 10);
            }).find("axis z of node 3 is held twice"),
            std::string::npos);
  EXPECT_EQ(parse_holds({"3:1,,1", "3:,1,"}, 10).size(), 3u);
}

TEST(HoldArgument, HoldsEachNodeOfAGroup) {
  const GroupNodes groups = [](const std::string& name) {
    if (name != "lid") throw std::runtime_error("no " + name);
    return std::vector<int>{4, 7};
  };
  const auto holds = parse_holds({"lid:,0.1,-0.2", "3:1,1,1"}, 10, groups);
  ASSERT_EQ(holds.size(), 7u);
  EXPECT_EQ(holds[2].terms[0].node, 7);
  EXPECT_EQ(holds[2].terms[0].axis, 1);
  EXPECT_EQ(holds[3].value, -0.2);
  EXPECT_EQ(refusal([&] { parse_holds({"roof:1,1,1"}, 10, groups); }), "no roof");
  EXPECT_NE(refusal([&] {
              parse_holds({"lid:1,,", "7:1,,"}, 10, groups);
            }).find("node 7 is held twice"),
            std::string::npos);
}

TEST(HoldArgument, TouchMovesTheNearestSurfacePoint) {
  const std::vector<Eigen::Vector3d> position{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}};
  const auto constraints =
      touch_constraints(parse_touch("0.25,0.5,-3:0,,-0.1"), position, {10, 11, 12, 13}, {{0, 1, 2}, {1, 2, 3}});
  ASSERT_EQ(constraints.size(), 2u);
  EXPECT_EQ(constraints[1].value, -0.1);
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (const auto& term : constraints[1].terms) {
    EXPECT_EQ(term.axis, 2);
    point += term.weight * position[term.node - 10];
  }
  EXPECT_LT((point - Eigen::Vector3d(0.25, 0.5, 0)).norm(), 0.05);
}

TEST(HoldArgument, TouchNeedsAWholePoint) {
  EXPECT_NE(refusal([] { parse_touch("0.25,,3:0,0,1"); }).find("needs all of x, y, z"), std::string::npos);
  EXPECT_NE(refusal([] { parse_touch("1,2,3:,,"); }).find("no axis"), std::string::npos);
}

}  // namespace
}  // namespace palpate
