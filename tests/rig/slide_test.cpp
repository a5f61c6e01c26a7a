#include "tools/rig/slide.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/mesh/generators.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tools/rig/example_bodies.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 0.001;

/// Forces over half a second at the slide's speed, after a run-up of 50 ticks.
template <class Force>
std::vector<SlideTick> ticks_of(Force&& force, double tangential = 0) {
  std::vector<SlideTick> ticks;
  for (int i = -50; i < 500; ++i) ticks.push_back({i * kSlideSpeed * kTick, force(i * kTick), tangential});
  return ticks;
}

SlideMeasures measured(const std::vector<SlideTick>& ticks) {
  return measure_slide(ticks, line_through(ticks), kTick);
}

TEST(SlideMeasures, ASteadyRiseIsNoRipple) {
  const auto m = measured(ticks_of([](double t) { return 2 + 0.4 * (t - 0.2495); }));
  EXPECT_NEAR(m.mean, 2, 1e-12);
  EXPECT_LT(m.ripple, 1e-12);
  EXPECT_LT(m.buzz, 1e-12);
  EXPECT_NEAR(m.jump, 0.4 * kTick / 2, 1e-12);
  EXPECT_EQ(m.turn, 0);
}

TEST(SlideMeasures, AWaveIsARippleAndABuzzWhereItIsFast) {
  const auto wave = [](double hertz) {
    return measured(ticks_of([=](double t) { return 2 + 0.02 * std::sin(2 * std::numbers::pi * hertz * t); }));
  };
  const double rms = 0.01 / std::numbers::sqrt2;
  EXPECT_NEAR(wave(20).ripple, rms, 0.02 * rms);
  EXPECT_LT(wave(20).buzz, 1e-3 * rms);
  EXPECT_NEAR(wave(180).ripple, rms, 0.02 * rms);
  EXPECT_NEAR(wave(180).buzz, rms, 0.02 * rms);
}

TEST(SlideMeasures, AStepIsAJumpAndTheRunUpCountsForNothing) {
  auto ticks = ticks_of([](double t) { return t < 0 ? 9 : t < 0.25 ? 1 : 1.1; });
  const auto m = measured(ticks);
  EXPECT_NEAR(m.jump, 0.1 / m.mean, 1e-9);
  EXPECT_NEAR(m.mean, 1.05, 1e-3);
}

TEST(SlideMeasures, AToolIsPushedAlongWhereTheForceOnItPointsAlongItsMotion) {
  EXPECT_EQ(measured(ticks_of([](double) { return 1.0; }, -0.3)).turn, 0);
  EXPECT_EQ(measured(ticks_of([](double) { return 1.0; }, 0.0019)).turn, 0);
  EXPECT_EQ(measured(ticks_of([](double) { return 1.0; }, 0.0021)).turn, 1);
}

TEST(SlideMeasures, ATrendCountsInShapeAlone) {
  const auto ticks = ticks_of([](double t) { return 3 * (1 + t * t); });
  std::vector<double> trend;
  for (const SlideTick& t : ticks) trend.push_back(1 + std::pow(t.path / kSlideSpeed, 2));
  EXPECT_LT(measure_slide(ticks, trend, kTick).ripple, 1e-12);
  EXPECT_GT(measured(ticks).ripple, 1e-3);
}

TEST(SlideMeasures, SpreadIsTheRangeOverTheMean) {
  EXPECT_NEAR(spread_of(std::vector{0.9, 1.0, 1.1}), 0.2, 1e-12);
}

SurfaceMap vault() {
  // Half of a cylinder that lies along y.
  SurfaceMap map;
  constexpr int around = 40, along = 8;
  for (int i = 0; i < around; ++i)
    for (int k = 0; k < along; ++k) {
      const double angle = std::numbers::pi * i / (around - 1);
      map.position.emplace_back(0.05 * std::cos(angle), 0.01 * k, 0.05 * std::sin(angle));
      map.fixed.push_back({false, false, false});
    }
  for (int i = 0; i + 1 < around; ++i)
    for (int k = 0; k + 1 < along; ++k) {
      const int a = i * along + k, b = a + along;
      map.triangles.push_back({a, a + 1, b});
      map.triangles.push_back({b, a + 1, b + 1});
    }
  map.touchable = map.size();
  return map;
}

TEST(SurfacePath, GoesInEvenStepsOverACurveAndPressesAgainstASmoothNormal) {
  const SurfaceMap map = vault();
  const int middle = static_cast<int>(map.triangles.size()) / 2;
  const SurfacePlace start = places_in(map, middle).front();
  const SurfacePath path = surface_path(map, start, {.length = 0.04, .run_up = 0.006, .step = 1e-4, .clear = 0});
  ASSERT_NEAR(static_cast<double>(path.places.size()), 461, 1);
  EXPECT_EQ(path.run_up, 60);
  EXPECT_NEAR(path.at(60), 0, 1e-15);
  for (std::size_t i = 1; i < path.places.size(); ++i) {
    const SurfacePlace &a = path.places[i - 1], &b = path.places[i];
    EXPECT_NEAR((b.point - a.point).norm(), 1e-4, 5e-6) << i;
    EXPECT_LT((b.inward - a.inward).norm(), 4e-3) << i;  // a facet turns by 0.08
    EXPECT_LT(b.inward.dot(Vector3d(b.point.x(), 0, b.point.z()).normalized()), -0.999) << i;
    EXPECT_NEAR(std::hypot(b.point.x(), b.point.z()), 0.05, 1e-4) << i;
  }
}

TEST(SurfacePath, EndsBeforeAnEdgeAndIsRefusedWhereThereIsNoRoom) {
  const Archive archive = precompute(block_body<QuasiStaticSpec>(), block_mesh(8));
  const int top = nearest_triangle(archive.surface, Vector3d::Zero());
  const SurfacePlace start = places_in(archive.surface, top).front();
  EXPECT_LT((start.inward + Vector3d::UnitZ()).norm(), 1e-12);
  PathPlan plan{.length = 0.09, .run_up = 0.006, .step = 1e-3, .clear = 0.008};
  for (const SurfacePlace& place : surface_path(archive.surface, start, plan).places) {
    EXPECT_LT(place.point.head<2>().cwiseAbs().maxCoeff(), 0.042);
    EXPECT_EQ(place.point.z(), 0);
  }
  plan.length = 0.5;
  EXPECT_THROW(surface_path(archive.surface, start, plan), std::runtime_error);
}

TEST(Slide, OverAFineBlockIsSmoothFollowsTheDepthAndFrictionHoldsTheToolBack) {
  const Archive archive = precompute(block_body<QuasiStaticSpec>(), block_mesh(16));
  Scene scene = block_scene();
  scene.passivity.controller = false;
  scene.tools[0].max_force = scene.tools[0].max_force_rate = 1e9;
  const int top = nearest_triangle(archive.surface, Vector3d::Zero());
  const SurfacePath path = surface_path(archive.surface, places_in(archive.surface, top).front(),
                                        {.length = 0.02, .run_up = 0.008, .step = 5e-5, .clear = 0.008});
  const auto over = [&](double friction, double depth) {
    scene.contact.friction = friction;
    PressRig rig(scene, {archive});
    return slide(rig, path, 0.008, depth);
  };
  const auto free = over(0, 0.003), rubbing = over(0.3, 0.003), deep = over(0, 0.004);
  EXPECT_LT(measured(free).ripple, 0.15);
  EXPECT_EQ(measured(rubbing).turn, 0);
  EXPECT_NEAR(rubbing.back().tangential, -0.3 / std::hypot(1, 0.3) * rubbing.back().force, 0.1 * rubbing.back().force);
  EXPECT_NEAR(measured(deep).mean / measured(free).mean, std::pow(4.0 / 3, 1.5), 0.2);
}

}  // namespace
}  // namespace palpate
