#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "tests/catheter/settings.hpp"
#include "tests/catheter/tube_wall.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// A forceps in a clumsy hand: it goes from place to place before the duct's mouth at any speed, takes hold
/// of the catheter where it comes near it, feeds it in or draws it out, and drops it again; a hold that bears
/// too much slips.
class ClumsyHand {
 public:
  ClumsyHand(int tool, unsigned seed) : tool_(tool), random_(seed) { jaw_.translation() = Vector3d(0.02, 0.02, -0.02); }

  const Eigen::Isometry3d& jaw() const { return jaw_; }
  int grasps() const { return grasps_; }
  int drops() const { return drops_; }

  /// The three parts of the coming tick, behind `parts`.
  void move(CatheterBody& body, std::vector<CatheterTool>& parts) {
    const Eigen::Isometry3d before = jaw_;
    holding_ = body.holds(tool_);
    if (--left_ <= 0) plan(body);
    jaw_.translation() += step_;
    jaw_.linear() = (jaw_.linear() * Eigen::AngleAxisd(turn_, Vector3d::UnitX())).eval();
    for (int part = 0; part < 3; ++part) {
      const auto end = [&](const Eigen::Isometry3d& pose, double far) {
        return Vector3d(pose * Vector3d(0, part == 0 ? 0.03 * far : (part == 1 ? 1 : -1) * (holding_ ? 2e-3 : 5e-3),
                                        part == 0 ? 0 : -0.01 * far));
      };
      parts.push_back({.tool = tool_,
                       .part = part,
                       .before = {end(before, 0.2), end(before, 1)},
                       .now = {end(jaw_, 0.2), end(jaw_, 1)},
                       .radius = 1e-3});
    }
  }

  void slip(CatheterBody& body) {
    if (body.load(tool_) < 3) return;
    body.let_go(tool_);
    ++drops_;
  }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  void plan(CatheterBody& body) {
    const ChainPoint near = body.nearest(jaw_.translation());
    Vector3d target(uniform(-0.02, 0.02), uniform(-0.02, 0.02), uniform(-0.05, -0.004));
    if (body.holds(tool_)) {
      body.let_go(tool_);
    } else if ((body.place(near) - jaw_.translation()).norm() < 4e-3) {
      body.grasp(tool_, jaw_, near, 6e-3, 1e-4);
      ++grasps_;
      // Mostly towards the mouth or back.
      if (uniform(0, 1) < 0.8)
        target = {uniform(-2e-3, 2e-3), uniform(-2e-3, 2e-3), uniform(0, 1) < 0.7 ? -0.004 : -0.05};
    } else if (uniform(0, 1) < 0.7) {
      target = body.place(body.nearest({0, 0, uniform(-0.05, -0.01)}));
    }
    const double speed = std::exp(uniform(std::log(2e-3), std::log(1.0))), way = (target - jaw_.translation()).norm();
    left_ = 1 + std::min(800, static_cast<int>(way / (speed * 1e-3)));
    step_ = (target - jaw_.translation()) / std::max(1.0, way / (speed * 1e-3));
    turn_ = uniform(-1, 1) * std::min(0.002, 0.5 / left_);
  }

  bool holding_ = false;
  int tool_, left_ = 0, grasps_ = 0, drops_ = 0;
  std::mt19937 random_;
  Eigen::Isometry3d jaw_ = Eigen::Isometry3d::Identity();
  Vector3d step_ = Vector3d::Zero();
  double turn_ = 0;
};

/// 30 simulated seconds; an hour with PALPATE_LONG_TESTS in the environment.
int ticks() {
  return std::getenv("PALPATE_LONG_TESTS") ? 3600000 : 30000;
}

void manipulate(TubeWall& wall, double sleeve, double tip, unsigned seed) {
  CatheterSettings s = plain_catheter(0.12, 41);
  s.shape.tail.z() += tip;
  s.shape.tip.z() += tip;
  s.shape.sleeve = sleeve;
  s.shape.damping = 5;
  s.shape.gravity = {0, -2, 0};
  CatheterBody body(s, &wall);
  body.grasp(2, Eigen::Isometry3d::Identity(), {0, 0}, 0,
             1.0);  // a slack lead that keeps its tail from drifting away
  ClumsyHand left(0, seed), right(1, seed + 1);
  std::vector<CatheterTool> parts;
  double energy = 0, wall_energy = 0, deepest = 0, force = 0;
  int limited = 0, outside = 0, strayed = 0;
  for (int i = 0; i < ticks(); ++i) {
    parts.clear();
    left.move(body, parts);
    right.move(body, parts);
    const Eigen::Isometry3d jaws[2] = {left.jaw(), right.jaw()};
    body.step(parts, jaws);
    if (i % 50 == 0) {
      const WrongSide wrong = wrong_side(body, wall);
      outside += wrong.outside;
      strayed += wrong.strayed;
    }
    for (const Vector3d& p : body.positions()) ASSERT_LT(p.norm(), 0.5) << i;  // false also where it is not finite
    for (const WallForce& f : body.wall_forces()) force = std::max(force, f.force.norm());
    wall.advance(body.wall_forces());
    left.slip(body);
    right.slip(body);
    energy = std::max(energy, body.energy());
    wall_energy = std::max(wall_energy, wall.energy());
    deepest = std::max(deepest, body.inserted());
    limited += body.effort().limited;
  }
  std::printf("%d s: led in and outside %d, not led in and inside %d, energy %.3g J, wall %.3g J, force %.3g N\n",
              ticks() / 1000, outside, strayed, energy, wall_energy, force);
  ::testing::Test::RecordProperty("energy_uJ", static_cast<int>(1e6 * energy));
  ::testing::Test::RecordProperty("max_force_mN", static_cast<int>(1e3 * force));
  ::testing::Test::RecordProperty("grasps", left.grasps() + right.grasps());
  ::testing::Test::RecordProperty("drops", left.drops() + right.drops());
  ::testing::Test::RecordProperty("held_back", limited);
  EXPECT_EQ(outside, 0);
  EXPECT_EQ(strayed, 0);
  EXPECT_LT(energy, 0.1);
  EXPECT_LT(wall_energy, 0.2);
  EXPECT_GT(deepest, 0.01);
  EXPECT_GT(left.grasps() + right.grasps(), ticks() / 2000);
  EXPECT_GT(left.drops() + right.drops(), 0);
}

TEST(RandomManipulation, StaysFiniteAndInsideARigidDuct) {
  TubeWall wall({.length = 0.05, .bend = 15, .around = 20, .rings = 26});
  manipulate(wall, 0.04, -0.005, 1);
}

TEST(RandomManipulation, StaysFiniteAndInsideASoftDuct) {
  TubeWall wall({.length = 0.05, .bend = 15, .around = 20, .rings = 26, .modes = 30});
  manipulate(wall, 0.04, -0.005, 11);
}

TEST(RandomManipulation, StaysFiniteWithoutASleeve) {
  TubeWall wall({.length = 0.05, .around = 20, .rings = 26, .modes = 10});
  manipulate(wall, 0, 0.03, 21);
}

}  // namespace
}  // namespace palpate
