#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "tests/haptic/block_scene.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::BlockScene;

/// Wanders with the speed of a hand, and now and then jumps anywhere, through the organ included.
class Wanderer {
 public:
  explicit Wanderer(unsigned seed) : random_(seed) {}
  Vector3d next() {
    std::normal_distribution<double> push(0, 2e-5);
    std::uniform_real_distribution<double> across(-0.07, 0.07), height(-0.02, 0.03);
    if (std::uniform_int_distribution<int>(0, 400)(random_) == 0) {
      at_ = {across(random_), across(random_), height(random_)};
      speed_.setZero();
    }
    speed_ = 0.98 * speed_ + Vector3d(push(random_), push(random_), push(random_));
    at_ += speed_;
    at_ = at_.cwiseMax(Vector3d(-0.08, -0.08, -0.04)).cwiseMin(Vector3d(0.08, 0.08, 0.04));
    return at_;
  }

 private:
  std::mt19937 random_;
  Vector3d at_{0, 0, 0.03}, speed_ = Vector3d::Zero();
};

TEST(RandomMotion, ForcesStayFiniteWithinTheirLimitsAndNeverPull) {
  const int steps = std::getenv("PALPATE_LONG_TESTS") ? 300'000 : 6'000;
  for (const ContactRule rule : {ContactRule::barycentric, ContactRule::alpha})
    for (double friction : {0.0, 0.5}) {
      BlockScene s(2);
      s.scene.contact.rule = rule;
      s.scene.contact.friction = friction;
      for (Tool& tool : s.scene.tools) tool.max_force = 20;
      std::get<ProbeSpec>(s.scene.tools[1].end).radius = 0.016;  // larger than the triangles: touches with vertices
      HapticStep haptic(s.scene, s.archives);
      Wanderer a(1), b(2);
      haptic.start(std::array{tip_at(s.scene.tools[0], {0, 0, 0.03}), tip_at(s.scene.tools[1], {0.05, 0, 0.03})});
      int touching = 0;
      for (int i = 0; i < steps; ++i) {
        haptic.step(std::array{tip_at(s.scene.tools[0], a.next(), 1e-3 * i), tip_at(s.scene.tools[1], b.next())});
        for (int t = 0; t < 2; ++t) {
          ASSERT_TRUE(haptic.force(t).allFinite() && haptic.torque(t).allFinite()) << word_of(rule) << " step " << i;
          ASSERT_LE(haptic.force(t).norm(), 20 * (1 + 1e-12)) << word_of(rule) << " step " << i;
          ASSERT_FALSE(haptic.flags(t) & fault) << word_of(rule) << " step " << i;
        }
        for (const TouchContact& c : haptic.law(0).contacts()) {
          if (c.touch == Touch::open) continue;
          const double pressing = c.force.dot(c.normal);
          ASSERT_GE(pressing, -1e-6 * (1 + c.force.norm())) << word_of(rule) << " step " << i;
          touching += pressing > 1e-3;
        }
      }
      EXPECT_GT(touching, steps / 20);
    }
}

}  // namespace
}  // namespace palpate
