#include <gtest/gtest.h>

#include "tests/catheter/settings.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

CatheterTool rod(const Vector3d& at, const Vector3d& before, double radius = 1e-3) {
  const Vector3d half(0.03, 0, 0);
  return {
      .tool = 0, .part = 1, .before = {before - half, before + half}, .now = {at - half, at + half}, .radius = radius};
}

/// A catheter along z that a rod along x comes upon.
CatheterSettings held_ends() {
  CatheterSettings s = plain_catheter(0.12, 41);
  s.shape.damping = 20;
  return s;
}

void hold_ends(CatheterBody& body) {
  body.grasp(1, Eigen::Isometry3d::Identity(), {0, 0.5}, body.spacing(), 1e-4);
  body.grasp(2, Eigen::Isometry3d::Identity(), {39, 0.5}, body.spacing(), 1e-4);
}

TEST(CatheterUnderATool, IsPushedAsideAndPushesBack) {
  CatheterBody body(held_ends(), nullptr);
  hold_ends(body);
  Vector3d at(0, 0.005, -0.061);
  double force = 0;
  for (int i = 0; i < 1500; ++i) {
    const Vector3d before = at;
    if (i < 1000) at.y() -= 1e-5;
    body.step({{rod(at, before)}}, {});
    Vector3d sum = Vector3d::Zero(), all = Vector3d::Zero();
    for (const CatheterToolForce& f : body.tool_forces()) {
      all += f.force;
      if (f.part < 0) continue;
      EXPECT_EQ(f.tool, 0);
      EXPECT_EQ(f.part, 1);
      EXPECT_LT((f.point - at).tail<2>().norm(), 1.1e-3);
      sum += f.force;
    }
    force = -sum.y();
    if (i == 1499) {
      EXPECT_LT(all.norm(), 1e-3 * force);  // at rest the ends hold what the rod pushes
    }
  }
  // The middle has given way to the rod: by its depth less the springs' own share.
  EXPECT_NEAR(body.place(body.nearest(at)).y(), at.y() - 1e-3 - 1.25e-3 + force * 1e-4, 2e-4);
  EXPECT_GT(force, 0.01);
}

TEST(CatheterUnderATool, StaysOnItsSideHoweverHardItIsPressed) {
  CatheterSettings s = held_ends();
  s.young = 1e9;
  CatheterBody body(s, nullptr);
  hold_ends(body);
  Vector3d at(0, 0.004, -0.061);
  for (int i = 0; i < 800; ++i) {
    const Vector3d before = at;
    at.y() -= 1e-5;
    body.step({{rod(at, before)}}, {});
    for (const CatheterToolForce& f : body.tool_forces()) {
      ASSERT_LE(f.part == 1 ? f.force.y() : 0, 0) << i;
    }
  }
  EXPECT_FALSE(body.tool_forces().empty());
}

TEST(CatheterUnderATool, IsCarriedByFriction) {
  CatheterSettings s = plain_catheter(0.06, 21);
  s.shape.gravity = {0, -9.81, 0};
  s.shape.damping = 5;
  CatheterBody body(s, nullptr);
  // Two rods under it like forks of a lift, which then move along the catheter, slowly enough for friction.
  double z = 0;
  for (int i = 0; i < 1500; ++i) {
    const double before = z;
    if (i >= 500) z += 2e-5;
    CatheterTool a = rod({0, -2.25e-3, -0.045 + z}, {0, -2.25e-3, -0.045 + before});
    CatheterTool b = rod({0, -2.25e-3, -0.015 + z}, {0, -2.25e-3, -0.015 + before});
    b.part = 2;
    body.step({{a, b}}, {});
  }
  EXPECT_NEAR(body.positions()[10].z(), -0.03 + z, 0.1 * z);
  EXPECT_GT(body.positions()[10].y(), -2e-3);
}

TEST(CatheterGrasped, FollowsTheJawAndTellsTheLoad) {
  CatheterSettings s = plain_catheter(0.06, 21);
  s.shape.gravity = {0, -9.81, 0};
  s.shape.damping = 40;
  CatheterBody body(s, nullptr);
  Eigen::Isometry3d jaw = Eigen::Isometry3d::Identity();
  jaw.translation().z() = -0.03;
  body.grasp(3, jaw, body.nearest(jaw.translation()), 6e-3, 1e-4);
  EXPECT_TRUE(body.holds(3));
  const Vector3d to(0.01, 0.02, 0.03);
  for (int i = 0; i < 2000; ++i) {
    jaw.translation() = Vector3d(0, 0, -0.03) + std::min(1.0, i / 1000.0) * to;
    const Eigen::Isometry3d jaws[4] = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity(),
                                       Eigen::Isometry3d::Identity(), jaw};
    body.step({}, jaws);
  }
  EXPECT_LT((body.place({10, 0}) - (Vector3d(0, 0, -0.03) + to)).norm(), 1e-4);
  const double weight = 9.81 * 1000 * std::numbers::pi * 1.25e-3 * 1.25e-3 * 0.06;
  EXPECT_NEAR(body.load(3), weight, 0.02 * weight);
  body.let_go(3);
  EXPECT_FALSE(body.holds(3));
  EXPECT_EQ(body.load(3), 0);
  for (int i = 0; i < 200; ++i) body.step({}, {});
  EXPECT_LT(body.positions()[10].y(), to.y() - 0.003);
}

TEST(CatheterGrasped, TurnsWithTheJaw) {
  CatheterBody body(held_ends(), nullptr);
  Eigen::Isometry3d jaw = Eigen::Isometry3d::Identity();
  jaw.translation().z() = -0.06;
  body.grasp(0, jaw, body.nearest(jaw.translation()), 9e-3, 1e-4);
  for (int i = 0; i < 3000; ++i) {
    jaw.linear() = Eigen::AngleAxisd(std::min(1.0, i / 1500.0) * 1.0, Vector3d::UnitX()).toRotationMatrix();
    body.step({}, {&jaw, 1});
  }
  const Vector3d along = (body.place({22, 0}) - body.place({18, 0})).normalized();
  EXPECT_GT(along.dot(jaw.linear() * Vector3d::UnitZ()), 0.99);
}

TEST(CatheterGrasped, FindsPointsForTheJaws) {
  const CatheterBody body(held_ends(), nullptr);
  std::array<Vector3d, 8> found;
  EXPECT_EQ(body.points_near({0, 0, -0.06}, 0.0062, found), 5);
  EXPECT_EQ(body.points_near({0.1, 0, -0.06}, 0.006, found), 0);
  EXPECT_EQ(body.points_near({0, 0, -0.06}, 1, found), 8);
  EXPECT_EQ(body.nearest({0.3, 0, -0.0605}).segment, 19);
}

}  // namespace
}  // namespace palpate
