#include "common/tool/forceps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/tool/instrument.hpp"
#include "common/tool/moving_tool.hpp"
#include "tests/tool/count_allocations.hpp"
#include "tests/tool/example_forceps.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::kForceps;

TEST(Forceps, ThreeSegmentsMeetAtTheJointAndTheJawsOpenSymmetrically) {
  const double opening = 0.6;
  const auto parts = forceps_parts(kForceps, opening);
  const Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
  for (const ToolPart& part : parts) EXPECT_EQ(part.axis(tip).start, Vector3d::Zero());
  EXPECT_LT((parts[forceps_shaft].axis(tip).end - Vector3d(0, 0, -0.3)).norm(), 1e-15);
  EXPECT_LT((parts[forceps_jaw_a].axis(tip).end - 0.015 * Vector3d(0, std::sin(0.3), std::cos(0.3))).norm(), 1e-15);
  EXPECT_LT((parts[forceps_jaw_b].axis(tip).end - 0.015 * Vector3d(0, -std::sin(0.3), std::cos(0.3))).norm(), 1e-15);
  EXPECT_EQ(parts[forceps_shaft].radius, 0.0025);
  EXPECT_EQ(parts[forceps_jaw_b].radius, 0.001);
  for (const ToolPart& part : parts) EXPECT_NEAR(part.pose.linear().determinant(), 1, 1e-12);
}

TEST(Forceps, WhatSticksToAJawTurnsWithIt) {
  auto before = forceps_parts(kForceps, 0.8), now = before;
  MovingTool tool{.parts_before = before, .parts = now};
  const Vector3d on_jaw = tool.to_part(forceps_jaw_a, tool.axis(forceps_jaw_a).at(0.7) + Vector3d(0.001, 0, 0));
  set_opening(0.2, now);
  const Vector3d turned = tool.to_world(forceps_jaw_a, on_jaw);
  EXPECT_LT((turned - (tool.axis(forceps_jaw_a).at(0.7) + Vector3d(0.001, 0, 0))).norm(), 1e-15);
  EXPECT_LT((tool.to_part(forceps_jaw_a, turned) - on_jaw).norm(), 1e-15);
}

TEST(Forceps, TurningTheJawsAllocatesNothing) {
  auto parts = forceps_parts(kForceps, 0.8);
  const auto before = allocations();
  for (int i = 0; i < 100; ++i) set_opening(0.01 * i, parts);
  EXPECT_EQ(allocations(), before);
}

TEST(Forceps, BetweenTheJawsIsTheirWedge) {
  EXPECT_TRUE(between_jaws(kForceps, 0.6, {0, 0.001, 0.01}));
  EXPECT_FALSE(between_jaws(kForceps, 0.6, {0, 0.004, 0.01}));  // above jaw A
  EXPECT_FALSE(between_jaws(kForceps, 0.6, {0.002, 0, 0.01}));  // beside
  EXPECT_FALSE(between_jaws(kForceps, 0.6, {0, 0, 0.016}));     // ahead
  EXPECT_FALSE(between_jaws(kForceps, 0.6, {0, 0, -0.001}));    // behind the joint
}

TEST(Instruments, AProbeIsABallOnASegmentAndAForcepsSegments) {
  Tool tool;
  const auto probe = tool_parts(tool);
  const double tip = std::get<ProbeSpec>(tool.end).radius;
  ASSERT_EQ(probe.size(), 2u);
  EXPECT_EQ(probe[0].radius, tip);
  EXPECT_EQ(probe[0].length, 0);
  EXPECT_EQ(probe[0].axis(Eigen::Isometry3d::Identity()).start, Vector3d::Zero());
  EXPECT_EQ(probe[1].radius, tool.shaft_radius);
  EXPECT_EQ(probe[1].axis(Eigen::Isometry3d::Identity()).start, Vector3d(0, 0, -tip));
  EXPECT_NEAR((probe[1].axis(Eigen::Isometry3d::Identity()).end - Vector3d(0, 0, -tool.shaft_length)).norm(), 0, 1e-12);
  tool.end = ForcepsSpec{{.length = 0.02, .radius = 0.0015}};
  const auto parts = tool_parts(tool, 0.4);
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(parts[0].length, tool.shaft_length);
  EXPECT_EQ(parts[1].length, 0.02);
  EXPECT_EQ(parts[1].radius, 0.0015);
}

}  // namespace
}  // namespace palpate
