#include <gtest/gtest.h>

#include <random>

#include "tests/catheter/settings.hpp"
#include "tests/catheter/tube_wall.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

CatheterSettings before_the_mouth() {
  CatheterSettings s = plain_catheter(0.12, 41);
  s.shape.tail = {0.5e-3, 0, -0.125};
  s.shape.tip = {0.5e-3, 0, -0.005};
  s.shape.damping = 5;
  s.shape.gravity = {0, -9.81, 0};
  return s;
}

/// Pushes the catheter on, or draws it back, a few centimetres before the mouth at a time, as fingers would.
class Feeder {
 public:
  explicit Feeder(CatheterBody& body) : body_(body) {}
  void feed(double speed, int ticks, const std::function<void()>& each) {
    for (int i = 0; i < ticks; ++i) {
      if (!body_.holds(0) || jaw_.translation().z() > -0.008 || jaw_.translation().z() < -0.04) take();
      jaw_.translation().z() += speed * 1e-3;
      body_.step({}, {&jaw_, 1});
      each();
    }
  }

 private:
  void take() {
    const ChainPoint at = body_.nearest({0.5e-3, 0, -0.02});
    jaw_ = Eigen::Isometry3d::Identity();
    jaw_.translation() = body_.place(at);
    body_.grasp(0, jaw_, at, 8e-3, 1e-4);
  }
  CatheterBody& body_;
  Eigen::Isometry3d jaw_ = Eigen::Isometry3d::Identity();
};

TEST(CatheterInARigidDuct, GoesInAndOutThroughTheMouth) {
  for (const double bend : {0.0, 20.0, 40.0}) {
    const TubeWall wall({.length = 0.05, .bend = bend, .around = 20, .rings = 26});
    CatheterBody body(before_the_mouth(), &wall);
    Feeder feeder(body);
    int touched = 0;
    double most = 0;
    int tick = 0;
    const auto check = [&] {
      touched = std::max(touched, body.wall_contacts());
      most = std::max(most, body.energy());
      ASSERT_EQ(++tick % 5 == 0 ? misplaced(body, wall) : 0, 0) << bend;
    };
    feeder.feed(0.05, 900, check);
    EXPECT_NEAR(body.inserted(), 0.04, 1e-3) << bend;
    EXPECT_GE(touched, bend > 30 ? 3 : 1) << bend;
    feeder.feed(-0.06, 800, check);
    EXPECT_EQ(body.inserted(), 0) << bend;
    EXPECT_LT(most, 1e-3) << bend;
  }
}

TEST(CatheterInARigidDuct, DoesNotLeaveThroughTheWallAtAnySpeed) {
  TubeWall wall({.length = 0.06, .bend = 3});
  CatheterSettings s = plain_catheter(0.03, 11);
  s.shape.tail = {0.5e-3, 0, 0.015};
  s.shape.tip = {3e-3, 0.5e-3, 0.045};
  s.young = 1e6;
  CatheterBody body(s, &wall);
  ASSERT_EQ(std::count(body.inside().begin(), body.inside().end(), 1), 11);
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<unsigned char> state(body.state_size());
  for (int i = 0; i < 2000; ++i) {
    if (i % 20 == 0) {  // kicked across the duct, up to some 10 m/s
      body.save(state.data());
      auto* v = reinterpret_cast<Vector3d*>(state.data() + 11 * sizeof(Vector3d));
      const Vector3d kick = 5 * Vector3d(normal(random), normal(random), 0.2 * normal(random));
      for (int k = 0; k < 11; ++k) v[k] += kick;
      body.restore(state.data());
    }
    body.step({}, {});
    for (int k = 0; k < 11; ++k)
      if (body.inside()[k]) {
        ASSERT_TRUE(enclosed(body.positions()[k], wall)) << i << " " << k;
      }
  }
}

TEST(CatheterInARigidDuct, RestsOnTheFloorAtItsWeight) {
  const TubeWall wall({.length = 0.06});
  CatheterSettings s = plain_catheter(0.03, 11);
  s.shape.tail = {0, 0, 0.015};
  s.shape.tip = {0, 0, 0.045};
  s.shape.gravity = {0, -9.81, 0};
  CatheterBody body(s, &wall);
  for (int i = 0; i < 3000; ++i) body.step({}, {});
  Vector3d sum = Vector3d::Zero();
  for (const WallForce& f : body.wall_forces()) sum += f.force;
  const double weight = 9.81 * 1000 * std::numbers::pi * 1.25e-3 * 1.25e-3 * 0.03;
  EXPECT_NEAR(sum.y(), -weight, 0.02 * weight);
  for (const Vector3d& p : body.positions()) EXPECT_NEAR(p.y(), -(4.5e-3 - 1.75e-3), 0.1e-3);
  for (const Vector3d& v : body.velocities()) EXPECT_LT(v.norm(), 1e-3);
}

TEST(CatheterInARigidDuct, FrictionHoldsBelowItsLimitAndSlidesAboveIt) {
  for (const double slope : {0.2, 0.4}) {  // tangent of the incline, friction 0.3
    const TubeWall wall({.length = 0.2, .rings = 161, .twisted = false});
    CatheterSettings s = plain_catheter(0.03, 11);
    s.shape.tail = {0, 0, 0.015};
    s.shape.tip = {0, 0, 0.045};
    s.shape.gravity = {0, -9.81, 0};
    s.friction = 0.3;
    CatheterBody rested(s, &wall);
    for (int i = 0; i < 1000; ++i) rested.step({}, {});
    std::vector<unsigned char> state(rested.state_size());
    rested.save(state.data());
    s.shape.gravity = {0, -9.81, 9.81 * slope};
    CatheterBody body(s, &wall);
    body.restore(state.data());
    for (int i = 0; i < 200; ++i) body.step({}, {});
    const double speed = body.velocities()[5].z(), free = 9.81 * (slope - 0.3) * 0.2;
    if (slope < 0.3) {
      EXPECT_LT(speed, 1.2e-3);
    } else {
      EXPECT_NEAR(speed, free, 0.15 * free);
    }
  }
}

TEST(CatheterInADuct, IsRefusedWhereItIsTooWide) {
  const TubeWall wall({.radius = 1.7e-3});
  EXPECT_THROW(CatheterBody(before_the_mouth(), &wall), std::runtime_error);
}

TEST(CatheterInASoftDuct, PushesTheWallOutAndActsAsItIsActedUpon) {
  TubeWall wall({.length = 0.05, .bend = 30, .modes = 30, .residual = 0.01});
  CatheterSettings s = before_the_mouth();
  s.shape.damping = 0;
  s.shape.gravity.setZero();
  CatheterBody body(s, &wall);
  const Chain chain(s.shape, s.young, s.density);
  Feeder feeder(body);
  double pushed = 0;
  int touches = 0;
  std::vector<double> y_before, y_after;
  Vector3d momentum = Vector3d::Zero();
  feeder.feed(0.05, 700, [&] {
    // Momentum changes by the forces that are told.
    Vector3d now = Vector3d::Zero(), force = Vector3d::Zero();
    for (int i = 0; i < body.size(); ++i) now += chain.mass()[i] * body.velocities()[i];
    for (const WallForce& f : body.wall_forces()) force -= f.force;
    for (const CatheterToolForce& f : body.tool_forces()) force += f.force;
    ASSERT_LT((now - momentum - force * 1e-3).norm(), 1e-9 + 1e-5 * force.norm() * 1e-3);
    momentum = now;
    for (const WallForce& f : body.wall_forces()) {
      const Vector3d out =
          (wall.surface().positions()[f.anchor.nodes[1]] - wall.surface().positions()[f.anchor.nodes[0]])
              .cross(wall.surface().positions()[f.anchor.nodes[2]] - wall.surface().positions()[f.anchor.nodes[0]])
              .normalized();
      if (f.anchor.weights.minCoeff() <= 0) continue;  // on an edge the force has another direction
      ++touches;
      const double push = f.force.dot(out);
      EXPECT_GT(push, 0);
      EXPECT_LE((f.force - push * out).norm(), 1.25 * s.friction * push);  // Coulomb's cone, to what a tick settles it
    }
    ASSERT_EQ(misplaced(body, wall), 0);
    wall.advance(body.wall_forces());
    pushed = std::max(pushed, wall.energy());
  });
  EXPECT_GT(touches, 100);
  EXPECT_GT(pushed, 1e-8);
  EXPECT_GT(body.inserted(), 0.02);
}

TEST(CatheterInASoftDuct, SolvesForBothBodiesAtOnce) {
  // Where both bodies really are after the tick, the overlaps that are left make just the forces that acted.
  TubeWall wall({.length = 0.06, .modes = 40});
  CatheterSettings s = plain_catheter(0.03, 11);
  s.shape.tail = {0, 0, 0.015};
  s.shape.tip = {0, 0, 0.045};
  s.shape.gravity = {0, -50, 0};
  CatheterBody body(s, &wall);
  const double reach = body.radius() + wall.half_thickness();
  double largest = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<Vector3d> normal;
    body.step({}, {});
    for (const WallForce& f : body.wall_forces()) {
      const auto p = wall.surface().positions();
      const auto& n = f.anchor.nodes;
      normal.push_back((p[n[2]] - p[n[0]]).cross(p[n[1]] - p[n[0]]).normalized());
    }
    wall.advance(body.wall_forces());
    for (std::size_t k = 0; k < normal.size(); ++k) {
      const WallForce& f = body.wall_forces()[k];
      if (f.anchor.weights.minCoeff() <= 0) continue;  // at an edge the push has another direction
      const double force = -f.force.dot(normal[k]);
      double nearest = 1;
      for (const Vector3d& x : body.positions())
        nearest = std::min(nearest, std::abs(reach - WallTouches::kCompliance * force -
                                             normal[k].dot(x - anchor_position(f.anchor, wall.surface().positions()))));
      ASSERT_LT(nearest, 1e-9) << i;  // of overlaps of some 1e-7
      largest = std::max(largest, force);
    }
  }
  EXPECT_GT(largest, 1e-3);
  EXPECT_GT(body.wall_contacts(), 3);
}

TEST(CatheterInASqueezedDuct, IsTouchedFromBothSides) {
  TubeWall wall({.length = 0.06});
  CatheterSettings s = plain_catheter(0.03, 11);
  s.shape.tail = {0, 0, 0.015};
  s.shape.tip = {0, 0, 0.045};
  CatheterBody body(s, &wall);
  for (int i = 0; i < 500; ++i) {
    const double share = 0.75 * std::min(1.0, i / 400.0);  // flattened to a quarter of its height
    wall.given = [&](const Vector3d& rest) { return Vector3d(0, -share * rest.y(), 0); };
    wall.move();
    body.step({}, {});
    for (const Vector3d& p : body.positions()) ASSERT_LT(p.norm(), 0.1);
  }
  double up = 0, down = 0;
  for (const WallForce& f : body.wall_forces()) (f.force.y() > 0 ? up : down) += std::abs(f.force.y());
  EXPECT_GT(up, 1.0);
  EXPECT_NEAR(up, down, 0.01 * up);
  for (const Vector3d& p : body.positions()) EXPECT_LT(std::abs(p.y()), 2e-4);
}

TEST(CatheterInARigidDuct, IsHeldByASpringThatStiffensWithoutAJump) {
  for (const double gravity : {2e5, 1e6, 3e6, 6e6}) {  // 3 to 90 N a particle
    TubeWall wall({.length = 0.06});
    CatheterSettings s = plain_catheter(0.03, 11);
    s.shape.tail = {0, 0, 0.015};
    s.shape.tip = {0, 0, 0.045};
    s.shape.damping = 1000;
    s.shape.gravity = {0, -gravity, 0};
    CatheterBody body(s, &wall);
    for (int i = 0; i < 3000; ++i) body.step({}, {});
    const double reach = body.radius() + wall.half_thickness(), soft = WallTouches::kLedBack * reach;
    int compared = 0;
    for (const WallForce& f : body.wall_forces()) {
      if (f.anchor.weights.minCoeff() <= 1e-6) continue;  // on an edge the push has another direction
      const double force = f.force.norm(), within = std::min(force, soft / WallTouches::kCompliance);
      const double overlap = WallTouches::kCompliance * (within + (force - within) / WallTouches::kStiffening);
      const auto p = wall.surface().positions();
      const auto& n = f.anchor.nodes;
      const Vector3d inward = (p[n[2]] - p[n[0]]).cross(p[n[1]] - p[n[0]]).normalized();
      double nearest = 1;
      for (const Vector3d& x : body.positions())
        nearest = std::min(nearest, std::abs(reach - overlap - inward.dot(x - anchor_position(f.anchor, p))));
      EXPECT_LT(nearest, 0.05 * soft) << gravity << ": " << force << " N";
      ++compared;
    }
    EXPECT_GT(compared, 0) << gravity;
  }
}

/// A duct that is thrown to and fro at 6 m/s, by several times the wall's reach in a tick, over a catheter that lies
/// beside it or in it.
void throw_over(double beside) {
  TubeWall wall({.length = 0.06, .modes = 12, .frequency = 100});
  constexpr int kSideways = 11;  // it moves the tube's middle along x
  CatheterSettings s = plain_catheter(0.04, 21);
  s.shape.tail = {beside, 0, 0.01};
  s.shape.tip = {beside, 0, 0.05};
  s.shape.damping = 20;
  CatheterBody body(s, &wall);
  int touched = 0;
  double most = 0;
  for (int i = 0; i < 1000; ++i) {
    if (i % 50 == 0) wall.kick(kSideways, i % 100 ? -6 : 6);
    body.step({}, {});
    touched = std::max(touched, body.wall_contacts());
    const auto before = wall.surface().positions();
    const std::vector<Vector3d> was(before.begin(), before.end());
    wall.advance(body.wall_forces());
    for (std::size_t n = 0; n < was.size(); ++n) most = std::max(most, (wall.surface().positions()[n] - was[n]).norm());
    const WrongSide wrong = wrong_side(body, wall);
    ASSERT_EQ(wrong.outside + wrong.strayed, 0) << i;
  }
  EXPECT_GT(touched, 0);
  EXPECT_GT(most, 2 * (body.radius() + wall.half_thickness()));
}

TEST(CatheterAtASwingingDuct, StaysOutside) {
  throw_over(0.008);
}
TEST(CatheterAtASwingingDuct, StaysInside) {
  throw_over(0);
}

TEST(CatheterInASoftDuct, TakesNoMemoryInAStep) {
  TubeWall wall({.length = 0.05, .bend = 30, .modes = 30, .residual = 0.01});
  CatheterBody body(before_the_mouth(), &wall);
  Feeder feeder(body);
  feeder.feed(0.05, 400, [&] { wall.advance(body.wall_forces()); });
  const CatheterTool rod{.before = {Vector3d(-0.05, 0.002, -0.03), Vector3d(0.05, 0.002, -0.03)},
                         .now = {Vector3d(-0.05, 0.002, -0.03), Vector3d(0.05, 0.002, -0.03)},
                         .radius = 1e-3};
  const Eigen::Isometry3d jaw = Eigen::Isometry3d::Identity();
  const long before = allocations();
  for (int i = 0; i < 20; ++i) body.step({&rod, 1}, {&jaw, 1});
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace palpate
