#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/catheter/settings.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

double inertia(const CatheterSettings& s) {  // EI
  return s.young * std::numbers::pi * std::pow(s.shape.radius, 4) / 4;
}
double area(const CatheterSettings& s) {
  return std::numbers::pi * s.shape.radius * s.shape.radius;
}

Vector3d momentum(const CatheterBody& body, const Chain& chain) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < body.size(); ++i) sum += chain.mass()[i] * body.velocities()[i];
  return sum;
}

TEST(FreeCatheter, FallsAsAFreeBody) {
  for (const ChainIntegrator integrator : {ChainIntegrator::implicit, ChainIntegrator::semi_implicit}) {
    CatheterSettings s = plain_catheter();
    s.shape.gravity = {0, -9.81, 0};
    s.shape.integrator = integrator;
    CatheterBody body(s, nullptr);
    for (int i = 0; i < 300; ++i) body.step({}, {});
    for (int i = 0; i < body.size(); ++i) {
      EXPECT_NEAR(body.velocities()[i].y(), -9.81 * 0.3, 1e-9) << word_of(integrator);
      EXPECT_NEAR(body.positions()[i].y(), -0.5 * 9.81 * 0.09, 9.81 * 0.3 * 1e-3) << word_of(integrator);
    }
  }
}

TEST(FreeCatheter, FallsAndTurnsAsARigidRodHoweverStiff) {
  CatheterSettings s = plain_catheter();
  s.shape.gravity = {0, -9.81, 0};
  s.young = 1e15;
  CatheterBody body(s, nullptr);
  std::vector<unsigned char> state(body.state_size());
  body.save(state.data());
  auto* v = reinterpret_cast<Vector3d*>(state.data() + body.size() * sizeof(Vector3d));
  for (int i = 0; i < body.size(); ++i) v[i].x() = 2.0 * (body.positions()[i].z() + 0.06);  // 2 rad/s about its middle
  body.restore(state.data());
  for (int i = 0; i < 300; ++i) body.step({}, {});
  EXPECT_NEAR(body.velocities()[20].y(), -9.81 * 0.3, 1e-3);
  const Vector3d along = (body.positions()[40] - body.positions()[0]).normalized();
  EXPECT_NEAR(std::atan2(along.x(), along.z()), 0.6, 0.01);
}

TEST(FreeCatheter, DampingSlowsItExponentially) {
  CatheterSettings s = plain_catheter();
  s.shape.gravity = {0, -9.81, 0};
  s.shape.damping = 20;
  CatheterBody body(s, nullptr);
  for (int i = 0; i < 1000; ++i) body.step({}, {});
  EXPECT_NEAR(body.velocities()[10].y(), -9.81 / 20, 1e-6);
}

/// Holds the tail and the direction there, by the grasp of the first two particles.
void clamp_tail(CatheterBody& body, int tool = 0) {
  body.grasp(tool, Eigen::Isometry3d::Identity(), {0, 0.5}, body.spacing(), 1e-9);
}

TEST(FreeCatheter, DroopsLikeAClampedBeam) {
  CatheterSettings s = plain_catheter(0.12, 41);
  s.shape.gravity = {0, -0.2, 0};
  s.shape.damping = 40;
  CatheterBody body(s, nullptr);
  clamp_tail(body);
  for (int i = 0; i < 4000; ++i) body.step({}, {});
  // Clamped from the middle of the first segment on.
  const double length = 0.12 - 0.5 * body.spacing(), load = s.density * area(s) * 0.2;
  const double expected = load * std::pow(length, 4) / (8 * inertia(s));
  EXPECT_LT(expected, 0.1 * length);
  EXPECT_NEAR(-body.positions()[body.size() - 1].y(), expected, 0.03 * expected);
}

TEST(FreeCatheter, StretchesAsARodUnderLoad) {
  CatheterSettings s = plain_catheter();
  s.shape.damping = 40;
  CatheterBody body(s, nullptr);
  body.grasp(0, Eigen::Isometry3d::Identity(), {0, 0}, 0, 1e-9);
  Eigen::Isometry3d pull = Eigen::Isometry3d::Identity();
  body.grasp(1, pull, {body.size() - 2, 1}, 0, 1e-6);
  pull.translation().z() = 1e-3;
  const Eigen::Isometry3d jaws[2] = {Eigen::Isometry3d::Identity(), pull};
  for (int i = 0; i < 3000; ++i) body.step({}, jaws);
  const double elongation = body.positions()[body.size() - 1].z() - body.positions()[0].z() - 0.12;
  EXPECT_NEAR(body.load(1), s.young * area(s) / 0.12 * elongation, 1e-6 * body.load(1));
  EXPECT_NEAR(body.load(0), body.load(1), 1e-6 * body.load(1));
  EXPECT_GT(elongation, 0.95e-3);
}

TEST(FreeCatheter, KeepsMomentumAndLosesEnergyWithoutInput) {
  for (const ChainIntegrator integrator : {ChainIntegrator::implicit, ChainIntegrator::semi_implicit}) {
    CatheterSettings s = plain_catheter(0.12, 31);
    s.young = 2e6;
    s.shape.integrator = integrator;
    CatheterBody body(s, nullptr);
    const Chain chain(s.shape, s.young, s.density);
    // Two grasps deform it, and let go.
    Eigen::Isometry3d jaws[2] = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()};
    body.grasp(0, jaws[0], {0, 0.5}, body.spacing(), 1e-4);
    body.grasp(1, jaws[1], {20, 0.5}, body.spacing(), 1e-4);
    for (int i = 0; i < 200; ++i) {
      jaws[1].translation().x() += 1e-4;
      jaws[1].translation().z() -= 5e-5;
      body.step({}, jaws);
    }
    body.let_go(0);
    body.let_go(1);
    body.step({}, {});
    const Vector3d begin = momentum(body, chain);
    double energy = body.energy();
    const double first = energy;
    for (int i = 0; i < 2000; ++i) {
      body.step({}, {});
      if (s.shape.integrator == ChainIntegrator::implicit) {
        EXPECT_LE(body.energy(), energy * (1 + 1e-3) + 1e-15) << i;
      }
      energy = body.energy();
      ASSERT_LE(energy, 1.05 * first) << word_of(integrator) << i;
    }
    EXPECT_LT((momentum(body, chain) - begin).norm(), 1e-9 * std::sqrt(first)) << word_of(integrator);
    if (s.shape.integrator == ChainIntegrator::implicit) {
      EXPECT_LT(energy, 0.5 * first);
    }
  }
}

TEST(FreeCatheter, BendsAtTheFrequencyOfAFreeBeam) {
  CatheterSettings s = plain_catheter(0.12, 41);
  s.step = 2e-5;
  CatheterBody body(s, nullptr);
  // Its first bending shape, nearly: two ends against the middle.
  const double length = 0.12, mu = s.density * area(s);
  const double expected = std::pow(4.73004 / length, 2) * std::sqrt(inertia(s) / mu);
  Eigen::Isometry3d jaws[3] = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity(),
                               Eigen::Isometry3d::Identity()};
  body.grasp(0, jaws[0], {0, 0}, 0, 1e-3);
  body.grasp(1, jaws[1], {20, 0}, 0, 1e-3);
  body.grasp(2, jaws[2], {39, 1}, 0, 1e-3);
  jaws[1].translation().x() = 1e-3;
  for (int i = 0; i < 20000; ++i) body.step({}, jaws);
  for (int tool = 0; tool < 3; ++tool) body.let_go(tool);
  // Deflection of the middle against the mean of the ends, without its mean: crossings tell the period.
  std::vector<double> bow;
  for (int i = 0; i < 20000; ++i) {
    body.step({}, {});
    bow.push_back(body.positions()[20].x() - 0.5 * (body.positions()[0].x() + body.positions()[40].x()));
  }
  std::vector<double> crossings;
  for (std::size_t i = 6000; i < bow.size(); ++i)
    if (bow[i - 1] < 0 && bow[i] >= 0) crossings.push_back((i - bow[i] / (bow[i] - bow[i - 1])) * s.step);
  ASSERT_GE(crossings.size(), 3u);
  const double period = (crossings.back() - crossings.front()) / (crossings.size() - 1);
  EXPECT_NEAR(2 * std::numbers::pi / period, expected, 0.03 * expected);
}

TEST(FreeCatheter, StaysBoundedAtAnyStiffness) {
  for (double young = 1e3; young <= 1e15; young *= 100) {
    CatheterSettings s = plain_catheter(0.12, 41);
    s.young = young;
    CatheterBody body(s, nullptr);
    const Chain chain(s.shape, s.young, s.density);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Eigen::Isometry3d jaw = Eigen::Isometry3d::Identity();
    double fastest = 0;
    for (int i = 0; i < 3000; ++i) {
      // Kicks: a hand that jumps by up to a millimetre every 20 ms, elsewhere each time, and lets go between.
      if (i % 20 == 0) {
        jaw = Eigen::Isometry3d::Identity();
        const ChainPoint at{static_cast<int>(20 + 19 * uniform(random)), 0.5};
        body.grasp(0, jaw, at, 0, 1e-4);
        for (int axis = 0; axis < 3; ++axis) jaw.translation()[axis] = 1e-3 * uniform(random);
      }
      if (i % 20 == 10) body.let_go(0);
      body.step({}, {&jaw, 1});
      for (const Vector3d& v : body.velocities()) {
        ASSERT_TRUE(v.allFinite()) << young << " " << i;
        fastest = std::max(fastest, v.norm());
      }
    }
    EXPECT_LT(fastest, 3.0) << young;
    double kinetic = 0, length = 0;
    for (int i = 0; i < body.size(); ++i) kinetic += 0.5 * chain.mass()[i] * body.velocities()[i].squaredNorm();
    for (int i = 0; i + 1 < body.size(); ++i) length += (body.positions()[i + 1] - body.positions()[i]).norm();
    EXPECT_LT(kinetic, 1e-3) << young;
    if (young >= 1e9) {
      EXPECT_NEAR(length, 0.12, 1e-4) << young;
    }
  }
}

TEST(FreeCatheter, SubstepsFollowFromTheStiffness) {
  CatheterSettings s = plain_catheter(0.12, 41);
  s.shape.integrator = ChainIntegrator::semi_implicit;
  s.young = 1e6;
  const CatheterBody body(s, nullptr);
  const double bound = Chain(s.shape, s.young, s.density).frequency_bound();
  EXPECT_GT(body.substeps(), 1);
  EXPECT_LE(s.step / body.substeps() * bound, 1.5);
  s.young = 1e9;
  EXPECT_THROW(
      try { CatheterBody(s, nullptr); } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find("substeps"), std::string::npos);
        throw;
      },
      std::runtime_error);
  s.shape.integrator = ChainIntegrator::implicit;
  EXPECT_EQ(CatheterBody(s, nullptr).substeps(), 1);
}

TEST(FreeCatheter, SleeveGuidesAndStopsTheTail) {
  CatheterSettings s = plain_catheter(0.12, 41);
  s.shape.sleeve = 0.05;
  s.shape.gravity = {0, -9.81, 0};
  s.shape.damping = 20;
  CatheterBody body(s, nullptr);
  Eigen::Isometry3d jaw = Eigen::Isometry3d::Identity();
  body.grasp(0, jaw, {25, 0.5}, body.spacing(), 1e-4);
  const auto feed = [&](double by, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      jaw.translation().z() += by / ticks;
      body.step({}, {&jaw, 1});
      for (const Vector3d& p : body.positions()) ASSERT_LT(p.z() < -0.12 + 0.05 ? p.head<2>().norm() : 0.0, 2e-4);
    }
  };
  feed(-0.06, 1000);  // withdrawn beyond the resting tail
  EXPECT_LT(body.positions()[0].z(), -0.17);
  feed(0.11, 2000);  // to the stop: the tail stays in the sleeve
  EXPECT_LT(body.positions()[0].z(), -0.12 + 0.051);
}

TEST(FreeCatheter, StateComesBackBitForBit) {
  CatheterSettings s = plain_catheter(0.12, 31);
  s.shape.gravity = {0, -9.81, 0};
  const CatheterTool rod{.tool = 1,
                         .part = 2,
                         .before = {Vector3d(-0.05, -0.004, -0.03), Vector3d(0.05, -0.004, -0.03)},
                         .now = {Vector3d(-0.05, -0.004, -0.03), Vector3d(0.05, -0.004, -0.03)},
                         .radius = 1e-3};
  CatheterBody a(s, nullptr), b(s, nullptr);
  Eigen::Isometry3d jaw = Eigen::Isometry3d::Identity();
  a.grasp(0, jaw, {3, 0.2}, 4e-3, 1e-4);
  for (int i = 0; i < 150; ++i) a.step({&rod, 1}, {&jaw, 1});
  std::vector<unsigned char> state(a.state_size()), again(a.state_size());
  a.save(state.data());
  b.restore(state.data());
  for (int i = 0; i < 100; ++i) {
    jaw.translation().x() += 1e-5;
    a.step({&rod, 1}, {&jaw, 1});
    b.step({&rod, 1}, {&jaw, 1});
  }
  a.save(state.data());
  b.save(again.data());
  EXPECT_EQ(state, again);
  EXPECT_FALSE(a.tool_forces().empty());
}

}  // namespace
}  // namespace palpate
