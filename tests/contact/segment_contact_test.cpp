// Parts of tools that are segments, against synthetic surfaces.
#include <gtest/gtest.h>

#include <cstring>

#include "common/geometry/dense_solvers.hpp"
#include "common/kernels/kernels.hpp"
#include "tests/contact/patch_touch.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::flat_patch;
using testing::HandledTool;
using testing::PatchTouch;
using testing::settle;
using testing::step;

TEST(SegmentContact, ThePressedSurfaceLiesOutsideADenseRowOfSpheresAndTheirForcesArePressure) {
  // Triangles smaller than the radius: vertices carry. These are the conditions that decide a row of spheres without
  // gaps.
  const double radius = 0.0016, length = 0.008;
  PatchTouch touch(flat_patch(31, 0.0008, 1e-3), 0, 1);
  HandledTool tool = HandledTool::segment(length, radius);
  const Vector3d along = Vector3d(1, 0.3, -0.08).normalized();
  tool.place_at({-0.004, 0, 0.003}, along);
  for (int i = 0; i < 60; ++i) {
    tool.move_to({-0.004, 0, 0.003 - 3e-5 * i}, along);
    step(touch, tool);
  }
  settle(touch, tool);
  const Segment axis = tool.moving().axis(0);
  const auto nearest_of_row = [&](const Vector3d& x) {
    Vector3d nearest = axis.start;
    for (int k = 0; k <= 4000; ++k)
      if ((axis.at(k / 4000.0) - x).norm() < (nearest - x).norm()) nearest = axis.at(k / 4000.0);
    return nearest;
  };
  const auto& x = touch.surface().positions();
  for (const Vector3d& p : x)
    ASSERT_TRUE((nearest_point(axis, p) - p).norm() > 2 * radius || (p - nearest_of_row(p)).norm() > radius - 2e-7);
  int pressing = 0;
  for (const TouchContact& c : touch.law().contacts()) {
    ASSERT_FALSE(c.face);
    if (c.touch == Touch::open) continue;
    ++pressing;
    const Vector3d outward = (c.position - nearest_of_row(c.position)).normalized();
    ASSERT_LT((c.position - nearest_of_row(c.position)).norm(), radius + 2e-7);
    ASSERT_GE(c.force.dot(outward), 0);
    ASSERT_LT((c.force - c.force.dot(outward) * outward).norm(), 2e-3 * c.force.norm());
  }
  EXPECT_GT(pressing, 10);
  EXPECT_GT(touch.force(0).z(), 0.01);
}

/// Two plates of large triangles that face each other, [m] apart.
Archive gap_between_plates(double width) {
  const Archive plate = flat_patch(7, 0.01, 1e-2);
  Archive both = plate;
  const int n = plate.surface.touchable;
  for (const Vector3d& x : plate.surface.position) both.surface.position.push_back(x + Vector3d(0, 0, width));
  for (int i = 0; i < n; ++i) both.surface.node_number.push_back(n + i);
  both.surface.fixed.resize(2 * n, {false, false, false});
  for (const auto& [a, b, c] : plate.surface.triangles) both.surface.triangles.push_back({n + a, n + c, n + b});
  both.surface.touchable = 2 * n;
  for (const Dof& d : plate.touchable_dofs) both.touchable_dofs.push_back({n + d.node, d.axis});
  for (int i = 0; i < 3 * n; ++i) {
    both.touchable_compliance.insert(both.touchable_compliance.end(), 3 * n, 0.0);
    const auto row = plate.touchable_compliance.begin() + i * (i + 1) / 2;
    both.touchable_compliance.insert(both.touchable_compliance.end(), row, row + i + 1);
  }
  return both;
}

TEST(SegmentContact, BetweenTwoFacesOfACutBothPress) {
  const double radius = 0.001, width = 0.0018;
  PatchTouch touch(gap_between_plates(width), 0, 1);
  HandledTool tool = HandledTool::segment(0.002, radius);  // no room for two contacts side by side
  tool.place_at({0.001, 0.003, 0.5 * width}, Vector3d::UnitX());
  settle(touch, tool);
  double below = 0, above = 0;
  for (const TouchContact& c : touch.law().contacts())
    (c.normal.z() < 0 ? below : above) += std::abs(c.force.dot(c.normal));
  EXPECT_GT(below, 0.005);
  EXPECT_NEAR(above, below, 0.2 * below);
}

TEST(SegmentContact, OnAPlateOfLargeTrianglesSeveralPlacesCarryAndTheTorqueIsTheirMomentAboutTheJoint) {
  const double radius = 0.001, length = 0.03;
  PatchTouch touch(flat_patch(9, 0.01, 1e-2), 0, 1);
  HandledTool tool = HandledTool::segment(length, radius);
  const Vector3d along = Vector3d(1, 0.2, -0.01).normalized(), joint(-0.017, 0.002, 0.0009);
  tool.place_at(joint + Vector3d(0, 0, 0.0015), along);
  for (int i = 0; i <= 15; ++i) {
    tool.move_to(joint + Vector3d(0, 0, 0.0001 * (15 - i)), along);
    step(touch, tool);
  }
  settle(touch, tool);
  // By hand: the points found, held at their gaps along their normals by the plate's own compliance.
  std::vector<TouchContact> held;
  for (const TouchContact& c : touch.law().contacts())
    if (c.touch != Touch::open) held.push_back(c);
  const int n = static_cast<int>(held.size());
  ASSERT_GE(n, 2);
  MatrixXd a(n, n);
  VectorXd gap(n);
  for (int i = 0; i < n; ++i) {
    EXPECT_TRUE(held[i].face);
    for (int j = 0; j < n; ++j) {
      a(i, j) = 0;
      for (int v = 0; v < 3; ++v)
        for (int w = 0; w < 3; ++w)
          for (int r = 0; r < 3; ++r)
            for (int s = 0; s < 3; ++s)
              a(i, j) += held[i].anchor.weights[v] * held[j].anchor.weights[w] * held[i].normal[r] * held[j].normal[s] *
                         touch.compliance().column(held[j].anchor.nodes[w], s)[3 * held[i].anchor.nodes[v] + r];
      EXPECT_TRUE(i == j || held[i].anchor.nodes != held[j].anchor.nodes);
    }
    gap[i] = held[i].plane - held[i].normal.dot(anchor_position(held[i].anchor, touch.archive().surface.position));
  }
  const VectorXd pressing = DenseCholesky(a).solve(gap);
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  for (int i = 0; i < n; ++i) {
    EXPECT_GT(pressing[i], 0);
    force -= pressing[i] * held[i].normal;
    torque -= pressing[i] * (held[i].position - joint).cross(held[i].normal);
  }
  EXPECT_LT((touch.force(0) - force).norm(), 1e-9 * force.norm());
  EXPECT_LT((touch.torque(0, joint) - torque).norm(), 1e-6 * torque.norm());
  EXPECT_LT(torque.y(), -0.2 * length * force.norm());  // the plate turns the jaw up, away from itself
}

TEST(SegmentContact, WithoutFrictionASegmentSlidesAlongItselfFreelyAndWithItAgainstMuTimesThePressure) {
  for (const double friction : {0.0, 0.3}) {
    PatchTouch touch(flat_patch(25, 0.005, 1e-2), friction, 1);
    HandledTool tool = HandledTool::segment(0.02, 0.001);
    const Vector3d along = Vector3d(1, 0.15, 0).normalized();
    const Vector3d start(-0.03, 0, 0.0004);
    constexpr double slope = 0.05;
    tool.place_at(start + Vector3d(0, 0, 0.001), along);
    tool.move_to(start, along);
    step(touch, tool);
    int measured = 0;
    for (int i = 1; i <= 400; ++i) {
      tool.move_to(start + 1e-4 * i * along, along);
      step(touch, tool);
      const Vector3d force = touch.force(0);
      ASSERT_GT(force.z(), 0) << i;
      if (i < 100) continue;
      // The dents that it crosses push it on and back a little, without friction by their slopes alone.
      ASSERT_LT(force.dot(along), slope * force.z()) << i;
      ASSERT_GT(force.dot(along), -(friction + slope) * force.z()) << i;
      measured += -force.dot(along) > 0.9 * friction * force.z();
    }
    EXPECT_TRUE(friction == 0 || measured > 150);  // most of the way every place slips
  }
}

TEST(SegmentContact, WhatSticksToAJawTurnsWithIt) {
  const ForcepsShape shape{.shaft_length = 0.05, .jaw_length = 0.015, .jaw_radius = 0.001};
  PatchTouch touch(flat_patch(25, 0.005, 1e-2), 5.0, 3);
  HandledTool tool = HandledTool::forceps(shape, 0.5);
  // Above the plate along x, rolled so that jaw A turns down towards it.
  const Vector3d along = Vector3d::UnitX(), joint(-0.004, 0.001, 0.0042);
  const double roll = std::numbers::pi / 2;
  tool.place_at(joint, along, roll);
  const bool a_is_lower = tool.moving().axis(forceps_jaw_a).end.z() < joint.z();
  const int jaw = a_is_lower ? forceps_jaw_a : forceps_jaw_b;
  tool.stay();
  tool.open(0.56);
  step(touch, tool);
  ASSERT_GT(touch.pressing(), 0);
  const auto find = [&]() -> const TouchContact* {
    for (const TouchContact& c : touch.law().contacts())
      if (c.tool_point().part == jaw && c.touch == Touch::sticking) return &c;
    return nullptr;
  };
  ASSERT_NE(find(), nullptr);
  const Anchor anchor = find()->anchor;
  const Vector3d in_jaw = find()->tool_point().offset;
  for (int i = 1; i <= 20; ++i) {
    tool.stay();
    tool.open(0.56 + 0.004 * i);
    step(touch, tool);
    const TouchContact* c = find();
    ASSERT_NE(c, nullptr);
    ASSERT_EQ(c->anchor.nodes, anchor.nodes);
    ASSERT_LT((c->tool_point().offset - in_jaw).norm(), 1e-9);
    ASSERT_LT((c->position - tool.moving().to_world(jaw, in_jaw)).norm(), 1e-9) << i;
  }
}

TEST(SegmentContact, HalfTheWallsThicknessIsAddedToEachRadius) {
  for (const double offset : {0.0, 0.0004}) {
    PatchTouch touch(flat_patch(25, 0.005, 1e-2), 0, 1, {.offset = offset});
    HandledTool tool = HandledTool::segment(0.02, 0.001);
    const Vector3d along = Vector3d(1, 0.1, 0).normalized();
    tool.place_at({-0.01, 0, 0.003}, along);
    tool.move_to({-0.01, 0, 0.0012}, along);
    step(touch, tool);
    if (offset == 0) {
      EXPECT_EQ(touch.pressing(), 0);
    } else {
      ASSERT_GT(touch.pressing(), 0);
      for (const TouchContact& c : touch.law().contacts()) EXPECT_NEAR(c.position.z(), -0.0002, 1e-7);
    }
  }
}

TEST(SegmentContact, ASoftToolGivesWayByItsComplianceTimesTheForce) {
  const double softness = 2e-3;
  PatchTouch touch(flat_patch(25, 0.005, 1e-2), 0, 1, {.softness = {softness}});
  HandledTool tool = HandledTool::segment(0.02, 0.001);
  const Vector3d along = Vector3d(1, 0.1, 0).normalized();
  tool.place_at({-0.01, 0, 0.003}, along);
  tool.move_to({-0.01, 0, 0.0002}, along);
  step(touch, tool);
  ASSERT_GT(touch.pressing(), 0);
  for (const TouchContact& c : touch.law().contacts())
    EXPECT_NEAR(c.position.z(), -0.0008 + softness * c.force.dot(c.normal), 1e-12);
}

TEST(SegmentContact, ASegmentSteppedAboutAllocatesNothing) {
  const ForcepsShape shape{.shaft_length = 0.05, .jaw_length = 0.012, .jaw_radius = 0.001};
  PatchTouch touch(flat_patch(25, 0.0025, 2e-3), 0.3, 3);
  HandledTool tool = HandledTool::forceps(shape, 0.5);
  tool.place_at({0, 0, 0.02}, Vector3d(1, 0, -0.5).normalized());
  kernels::active();  // the code path is chosen once
  long allocated = -1;
  for (int i = 0; i < 400; ++i) {
    const Vector3d at(0.01 * std::sin(0.02 * i), 0.01 * std::cos(0.03 * i), 0.006 + 0.008 * std::cos(0.04 * i));
    tool.move_to(at, Vector3d(1, 0.3 * std::sin(0.01 * i), -0.5).normalized(), 0.02 * i);
    tool.open(0.5 + 0.3 * std::sin(0.05 * i));
    const MovingTool moving = tool.moving();
    const long before = allocations();
    touch.step({&moving, 1});
    allocated = std::max(allocated, allocations() - before);
  }
  EXPECT_EQ(allocated, 0);
}

TEST(SegmentContact, ARestoredStateGoesOnBitForBit) {
  const ForcepsShape shape{.shaft_length = 0.05, .jaw_length = 0.012, .jaw_radius = 0.001};
  const auto make = [] {
    return PatchTouch(flat_patch(25, 0.0025, 2e-3), 0.3, 3, {.offset = 2e-4, .softness = {1e-4}});
  };
  const auto pose = [&](HandledTool& tool, int i) {
    const Vector3d at(0.01 * std::sin(0.02 * i), 0.01 * std::cos(0.03 * i), 0.0035 + 0.002 * std::cos(0.04 * i));
    tool.move_to(at, Vector3d(1, 0.3 * std::sin(0.01 * i), -0.3).normalized(), 0.02 * i);
    tool.open(0.5 + 0.3 * std::sin(0.05 * i));
  };
  PatchTouch first = make();
  HandledTool tool = HandledTool::forceps(shape, 0.5);
  pose(tool, 0);
  tool.stay();
  for (int i = 0; i < 150; ++i) {
    pose(tool, i);
    step(first, tool);
  }
  ASSERT_GT(first.pressing(), 0);
  std::vector<unsigned char> state(first.state_size());
  first.save(state.data());
  first.law().forget_factor();
  PatchTouch second = make();
  const MovingTool moving = tool.moving();
  second.restore(state.data(), std::span<const MovingTool>(&moving, 1));
  for (int i = 150; i < 300; ++i) {
    pose(tool, i);
    step(first, tool);
    step(second, tool);
    const Vector3d f = first.force(0), g = second.force(0);
    ASSERT_EQ(std::memcmp(f.data(), g.data(), sizeof(double[3])), 0) << "step " << i;
    const Vector3d t = first.torque(0, tool.pose().translation()), u = second.torque(0, tool.pose().translation());
    ASSERT_EQ(std::memcmp(t.data(), u.data(), sizeof(double[3])), 0) << "step " << i;
  }
  std::vector<unsigned char> end_first(state.size()), end_second(state.size());
  first.save(end_first.data());
  second.save(end_second.data());
  EXPECT_EQ(end_first, end_second);
}

}  // namespace
}  // namespace palpate
