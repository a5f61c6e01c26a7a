// What an organ does while it is cut, and what is cut off it.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/mesh/generators.hpp"
#include "tests/deform/block_bench.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;
using testing::Bench;
using testing::block_scene;
using testing::from_above;
using testing::kRadius;
using testing::kTop;

TEST(DynamicOrgan, CauteryCutsWhileThePedalIsDownAndNotOtherwise) {
  Scene scene = block_scene();
  std::get<ProbeSpec>(scene.tools[0].end).cautery = Cautery{0.0065};
  Bench bench(scene);
  for (int i = 0; i < 100; ++i) bench.tick(from_above(i, 50, kTop + 0.01, kTop + kRadius - 0.002));
  EXPECT_TRUE(bench.organ().removed().empty());
  for (int i = 0; i < 200; ++i) bench.tick(kTop + kRadius - 0.002 - 4e-5 * i, 0, 1);
  EXPECT_GT(bench.organ().removed().size(), 20u);
  EXPECT_TRUE(bench.finite());
  const std::size_t cut = bench.organ().removed().size();
  for (int i = 0; i < 100; ++i) bench.tick(kTop + kRadius);
  EXPECT_EQ(bench.organ().removed().size(), cut);
  EXPECT_EQ(bench.organ().topology().alive_count() + static_cast<int>(cut), bench.organ().topology().size());
}

/// A scalpel whose ball is smaller than the tissue's triangles, and glows a little beyond it.
Scene fine_scalpel() {
  Scene scene = block_scene();
  ProbeSpec& probe = std::get<ProbeSpec>(scene.tools[0].end);
  probe.radius = 0.002;
  probe.cautery = Cautery{0.0022};
  scene.tools[0].shaft_radius = 0.001;
  scene.contact.rule = ContactRule::barycentric;
  return scene;
}

TEST(DynamicOrgan, WhatIsCutAwayUnderATipLetsGoBySmallSteps) {
  Bench bench(fine_scalpel(), middle_block_mesh(6));
  for (int i = 0; i < 400; ++i) bench.tick(from_above(i, 300, kTop + 0.003, kTop - 0.002), 0.001);
  const double pressed = bench.force().norm();
  ASSERT_GT(pressed, 0.01);
  double last = pressed, largest = 0;
  for (int i = 0; i < 15; ++i) {
    bench.tick(kTop - 0.002, 0.001, i == 0);
    const double now = bench.force().norm();
    largest = std::max(largest, std::abs(now - last));
    last = now;
  }
  EXPECT_FALSE(bench.organ().removed().empty());
  EXPECT_LT(last, 0.9 * pressed);  // the tissue that is left carries some of it by then
  EXPECT_LT(largest, 0.25 * pressed);
}

TEST(DynamicOrgan, NothingIsPressedThatHasBeenCutAway) {
  Bench bench(fine_scalpel(), middle_block_mesh(6));
  for (int i = 0; i < 300; ++i) bench.tick(from_above(i, 200, kTop + 0.003, kTop - 0.002), 0.001);
  const auto pressed_in_vain = [&] {
    const CutMesh& topology = bench.organ().topology();
    return std::ranges::count_if(bench.organ().contacts(), [&](const TouchContact& c) {
      const auto is_it = [&](int facet) { return topology.facet(facet) == c.anchor.nodes; };
      return c.face && !c.force.isZero(0) && std::ranges::none_of(topology.visible(), is_it);
    });
  };
  ASSERT_FALSE(bench.force().isZero(0));
  ASSERT_EQ(pressed_in_vain(), 0);
  for (int i = 0; i < 400; ++i) bench.tick(kTop - 0.002 - 1e-5 * i, 0.001, i < 300);
  EXPECT_GT(bench.organ().removed().size(), 3u);
  EXPECT_EQ(pressed_in_vain(), 0);
}

TEST(DynamicOrgan, WhatLetsGoWithinATickIsToldWithTheForceThatItHad) {
  Scene scene = fine_scalpel();
  moving_block_of(scene).material.young = 1e6;  // many steps a tick
  Bench bench(scene, middle_block_mesh(6));
  int told = 0;
  for (int i = 0; i < 400; ++i) {
    bench.tick(kTop + 0.0015 + 0.0015 * std::cos(0.1 * i), 0.001);  // taps
    for (const TouchContact& c : bench.organ().contacts()) told += c.touch == Touch::open && c.force.dot(c.normal) > 0;
  }
  EXPECT_GT(told, 0);
}

TEST(DynamicOrgan, ACutThroughEverythingLeavesARunningSystem) {
  Scene scene = block_scene();
  std::get<ProbeSpec>(scene.tools[0].end).cautery = Cautery{0.2};
  Bench bench(scene);
  for (int i = 0; i < 2500; ++i) bench.tick(0.02, 0, 1);
  EXPECT_EQ(bench.organ().topology().alive_count(), 0);
  EXPECT_TRUE(bench.finite());
  for (int i = 0; i < 10; ++i) bench.tick(0.02, 0, 1);
}

/// A post of which a blade cuts the upper half off, under a weight that draws it upwards.
class CutPost : public ::testing::Test {
 protected:
  static Scene post() {
    Scene scene = block_scene();
    moving_block_of(scene).dynamic.gravity = {0, 0, kGravity};  // upwards: off the base
    moving_block_of(scene).dynamic.damping = kDamping;
    moving_block_of(scene).dynamic.precision = Precision::float64;
    moving_block_of(scene).fixed[0].where = {
        .indices = {}, .box = Box{Vector3d(-1, -1, -1e-6), Vector3d(1, 1, 1e-6)}, .group = ""};
    std::get<ProbeSpec>(scene.tools[0].end).cautery = Cautery{0.0062};
    std::get<ProbeSpec>(scene.tools[0].end).radius = 0.003;
    scene.tools[0].pivot = {-0.2, 0, 0.02};
    scene.tools[0].axis = Vector3d::UnitX();
    scene.tools[0].up = Vector3d::UnitZ();
    return scene;
  }
  void at(double x) {
    ToolState s{.run = 7, .step = ++step_, .depth = 0.2 + x};
    s.pedal = 1;
    bench_.world().take(s);
    bench_.world().tick();
  }
  bool cut_free() { return bench_.organ().topology().parts(part_) == 2; }
  void cut() {
    for (int i = 0; i < 400 && !cut_free(); ++i) at(-0.03 + 0.06 * i / 400);
    ASSERT_TRUE(cut_free());
  }

  /// What floats: its mean velocity, and the energy of all its other motion, elastic and kinetic.
  struct Piece {
    Vector3d velocity = Vector3d::Zero();  ///< [m/s]
    double swing = 0;                      ///< [J]
  };
  Piece piece() {
    const DynamicOrgan& organ = bench_.organ();
    const DynamicModel& model = organ.model();
    cut_free();
    const int floating = part_[top()];
    std::vector<char> floats(organ.mesh().nodes(), 0);
    for (int t = 0; t < organ.topology().size(); ++t)
      if (part_[t] == floating)
        for (const int n : organ.topology().tetrahedron(t)) floats[n] = 1;
    double mass = 0;
    Piece piece;
    for (int n = 0; n < model.nodes(); ++n)
      if (floats[n]) mass += model.mass(n), piece.velocity += model.mass(n) * model.velocity(n);
    piece.velocity /= mass;
    for (int n = 0; n < model.nodes(); ++n)
      if (floats[n])
        piece.swing += 0.5 * model.mass(n) * (model.velocity(n) - piece.velocity).squaredNorm() -
                       0.5 * model.elastic_force(n).dot(model.displacement(n));
    return piece;
  }

  static constexpr double kGravity = 9.81, kDamping = 5;
  Bench bench_{post(), make_block({-0.01, -0.005, 0}, {0.01, 0.005, 0.04}, {4, 2, 8})};

 private:
  int top() const {
    const auto height = [&](int t) {
      return bench_.organ().mesh().rest[bench_.organ().topology().tetrahedron(t)[0]].z();
    };
    int top = -1;
    for (int t = 0; t < bench_.organ().topology().size(); ++t)
      if (part_[t] >= 0 && (top < 0 || height(t) > height(top))) top = t;
    return top;
  }
  std::vector<int> part_;
  std::uint64_t step_ = 0;
};

TEST_F(CutPost, APartCutFreeFallsStaysFiniteAndIsTakenAwayInTheEnd) {
  cut();
  for (int i = 0; i < 600; ++i) {
    at(0.05);
    ASSERT_TRUE(bench_.finite()) << i;
  }
  EXPECT_GT(bench_.organ().topology().alive_count(), 0);
  std::vector<int> part;
  EXPECT_EQ(bench_.organ().topology().parts(part), 1) << "what floated is gone, what is fixed is left";
}

TEST_F(CutPost, APartCutFreeFallsByItsWeightAlone) {
  cut();
  for (int i = 0; i < 50; ++i) at(0.05);  // what the blade did to it is over
  const Vector3d before = piece().velocity;
  for (int i = 0; i < 80; ++i) at(0.05);
  const double fallen = (piece().velocity - before).z();
  EXPECT_NEAR(fallen, kGravity * 0.08, 0.005 * kGravity * 0.08);
}

TEST_F(CutPost, APartCutFreeSwingsLessAndLess) {
  cut();
  for (int i = 0; i < 30; ++i) at(0.05);
  const double before = piece().swing;
  ASSERT_GT(before, 0);
  for (int i = 0; i < 80; ++i) at(0.05);
  // Half of its energy is kinetic, which loses 2 damping of itself a second; the part that is a turn keeps its own.
  EXPECT_LT(piece().swing, 0.8 * before);
}

}  // namespace
}  // namespace palpate
