#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "common/fem/direct.hpp"
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

TEST(DynamicOrgan, AtRestFeelsNothingAndStaysWhereItIs) {
  Bench bench(block_scene());
  for (int i = 0; i < 100; ++i) bench.tick(kTop + 0.02);
  EXPECT_TRUE(bench.force().isZero(0));
  for (int n = 0; n < bench.organ().mesh().nodes(); ++n)
    EXPECT_TRUE(bench.organ().model().displacement(n).isZero(1e-12));
}

TEST(DynamicOrgan, APressedTipFeelsWhatTheStaticSolverSaysForTheHeldNodes) {
  Scene scene = block_scene();
  moving_block_of(scene).dynamic.precision = Precision::float64;
  scene.contact = {.rule = ContactRule::barycentric, .friction = 10};
  Bench bench(scene);
  for (int i = 0; i < 3000; ++i) bench.tick(from_above(i, 500, kTop + kRadius + 0.001, kTop + kRadius - 0.004));
  const auto contacts = bench.organ().contacts();
  ASSERT_FALSE(contacts.empty());
  const TetMesh mesh = middle_block_mesh();
  const Archive& archive = bench.archives()[0];
  std::vector<Constraint> held;
  Vector3d sum = Vector3d::Zero();
  for (const TouchContact& c : contacts) {
    if (c.force.dot(c.normal) <= 0) continue;
    ASSERT_FALSE(c.face);
    const int node = c.anchor.nodes[0];
    for (int axis = 0; axis < 3; ++axis)
      held.push_back(hold(archive.surface.node_number[node], axis, bench.organ().model().displacement(node)[axis]));
    sum += c.force;
  }
  const StaticSolution exact = solve_direct(make_static_problem(moving_block_of(scene), mesh), held);
  Vector3d wanted = Vector3d::Zero();
  for (const TouchContact& c : contacts)
    if (c.force.dot(c.normal) > 0) wanted += exact.force[archive.surface.node_number[c.anchor.nodes[0]]];
  EXPECT_LT(sum.z(), -0.05);
  EXPECT_LT((sum - wanted).norm(), 0.01 * wanted.norm()) << sum.transpose() << " against " << wanted.transpose();
}

TEST(DynamicOrgan, LetsATipGoWithoutPullingAtIt) {
  Bench bench(block_scene());
  for (int i = 0; i < 300; ++i) bench.tick(from_above(i, 200, kTop + kRadius + 0.001, kTop + kRadius - 0.004));
  EXPECT_LT(bench.force().z(), -0.01);
  for (int i = 0; i < 400; ++i) {
    bench.tick(from_above(i, 200, kTop + kRadius - 0.004, kTop + 0.03));
    for (const TouchContact& c : bench.organ().contacts()) EXPECT_GE(c.force.dot(c.normal), 0);
  }
  EXPECT_TRUE(bench.force().isZero(0));
}

TEST(DynamicOrgan, ATipNeverTunnelsAtAnySpeed) {
  for (const double speed : {0.01, 0.1, 1.0, 5.0}) {
    Bench bench(block_scene());
    double z = kTop + 0.02;
    for (int i = 0; i < 20; ++i) bench.tick(z);
    for (; z > kTop - 0.01; z -= 1e-3 * speed) bench.tick(z);
    for (int i = 0; i < 20; ++i) bench.tick(kTop - 0.01);
    EXPECT_LT(bench.force().z(), -0.01) << speed << " m/s";
    EXPECT_TRUE(bench.finite());
  }
}

TEST(DynamicOrgan, JawsHoldWhatIsBetweenThemUntilTheyOpen) {
  Scene scene = block_scene();
  std::get<ProbeSpec>(scene.tools[0].end).jaws = ClosingJaws{0.012, 0.012, 0.1};
  Bench bench(scene);
  const double low = kTop + kRadius - 0.001;
  for (int i = 0; i < 50; ++i) bench.tick(from_above(i, 40, kTop + 0.012, low), 0, 0, 0.6);
  for (int i = 0; i < 20; ++i) bench.tick(low, 0, 0, 0.05);
  for (int i = 0; i < 300; ++i) bench.tick(from_above(i, 250, low, low + 0.008), 0, 0, 0.05);
  EXPECT_GT(bench.force().z(), 0.02) << "the tissue is pulled up";
  double highest = 0;
  for (const Vector3d& x : bench.organ().surface().positions()) highest = std::max(highest, x.z());
  EXPECT_NEAR(highest, kTop + 0.008, 0.0015);
  for (int i = 0; i < 500; ++i) bench.tick(low + 0.02, 0, 0, 0.6);
  EXPECT_TRUE(bench.force().isZero(0));
  for (const Vector3d& x : bench.organ().surface().positions()) EXPECT_LT(x.z(), kTop + 0.001);
}

TEST(DynamicOrgan, RestoredStateGoesOnBitForBit) {
  Scene scene = block_scene();
  std::get<ProbeSpec>(scene.tools[0].end).cautery = Cautery{0.0065};
  moving_block_of(scene).dynamic.gravity = {0, 0, -9.81};
  Bench first(scene), second(first);
  const auto z = [](int i) { return kTop + kRadius + 0.002 - 1.5e-5 * i; };
  for (int i = 0; i < 300; ++i) first.tick(z(i), 1e-5 * i, i > 200);
  second.world().restore(first.world().save());
  EXPECT_EQ(first.world().hash(), second.world().hash());
  for (int i = 300; i < 600; ++i) {
    first.tick(z(i), 1e-5 * i, i % 100 > 50);
    second.tick(z(i), 1e-5 * i, i % 100 > 50);
    ASSERT_EQ(first.world().hash(), second.world().hash()) << "tick " << i;
  }
  EXPECT_FALSE(first.organ().removed().empty());
  EXPECT_EQ(first.organ().removed(), second.organ().removed());
}

TEST(DynamicOrgan, ARestoredHybridGoesOnBitForBitFromAKeyframe) {
  HybridSpec split;
  split.hybrid.regions.push_back({{.box = Box{Vector3d(-1, -1, -1), Vector3d(-0.0026, 1, 1)}}});
  Scene scene = block_scene(split);
  scene.contact.rule = ContactRule::barycentric;
  moving_block_of(scene).dynamic.gravity = {0, 0, -9.81};
  Bench first(scene), second(first);
  const auto move = [](Bench& bench, int i) {
    bench.tick(kTop + kRadius + 0.002 - 5e-6 * std::min(i, 1000), 0.01 - 5e-6 * i);
  };
  const int keyframe = static_cast<int>(first.world().keyframe_interval());
  for (int i = 0; i < keyframe; ++i) move(first, i);
  EXPECT_FALSE(first.organ().condensed_part()->contacts().empty());
  second.world().restore(first.world().save());
  for (int i = keyframe; i < 3 * keyframe; ++i) {
    move(first, i);
    move(second, i);
    ASSERT_EQ(first.world().hash(), second.world().hash()) << "tick " << i;
  }
}

// Counts of ticks go down by one in a tick.
TEST(DynamicOrgan, AStateWhoseForcesFadeForLongerThanTheyDoIsRefused) {
  Scene scene = block_scene();
  std::get<ProbeSpec>(scene.tools[0].end).cautery = Cautery{0.0065};
  Bench bench(scene, middle_block_mesh(6));
  const double low = kTop + kRadius - 0.003;
  for (int i = 0; i < 300; ++i) bench.tick(from_above(i, 250, kTop + kRadius + 0.001, low));
  bench.tick(low, 0, true);
  ASSERT_FALSE(bench.organ().removed().empty());
  int counts = 0;
  for (int i = 0; i < 15; ++i) {
    std::vector<std::uint8_t> now = bench.world().save();
    bench.tick(low + 0.02);
    const std::vector<std::uint8_t> next = bench.world().save();
    if (next.size() != now.size()) continue;
    for (std::size_t at = 0; at + sizeof(int) <= now.size(); ++at) {
      int left, later;
      std::memcpy(&left, &now[at], sizeof left);
      std::memcpy(&later, &next[at], sizeof later);
      if (left < 2 || left > 20 || later != left - 1) continue;
      ++counts;
      for (const int wrong : {0, 21}) {
        std::memcpy(&now[at], &wrong, sizeof wrong);
        Bench other(bench);
        EXPECT_THROW(other.world().restore(now), std::runtime_error) << wrong << " ticks at byte " << at;
      }
      std::memcpy(&now[at], &left, sizeof left);
    }
    if (counts > 0) break;
  }
  EXPECT_GT(counts, 1) << "of nodes and of the tool";
}

TEST(DynamicOrgan, AStateOfAnotherSceneIsRefused) {
  Bench bench(block_scene());
  std::vector<std::uint8_t> state = bench.world().save();
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, state.size() / 2, state.size() - 1}) {
    Bench other(bench);
    EXPECT_THROW(other.world().restore(std::span(state).first(size)), std::runtime_error) << size;
  }
}

TEST(DynamicOrgan, AStateWithDamagedContactsIsRefused) {
  Bench bench(block_scene());
  for (int i = 0; i < 300; ++i) bench.tick(from_above(i, 200, kTop + kRadius + 0.001, kTop + kRadius - 0.004));
  const std::vector<std::uint8_t> state = bench.world().save();
  const TouchContact& first = bench.organ().contacts()[0];
  const auto* pattern = reinterpret_cast<const std::uint8_t*>(&first.anchor);
  const auto at = std::search(state.begin(), state.end(), pattern, pattern + sizeof first.anchor.nodes);
  ASSERT_NE(at, state.end());
  std::vector<std::uint8_t> damaged = state;
  damaged[static_cast<std::size_t>(at - state.begin()) + 3] = 0x7f;
  Bench other(bench), whole(bench);
  EXPECT_THROW(other.world().restore(damaged), std::runtime_error);
  EXPECT_NO_THROW(whole.world().restore(state));
}

TEST(DynamicOrgan, TearsBeyondItsThreshold) {
  Scene scene = block_scene();
  std::get<ProbeSpec>(scene.tools[0].end).jaws = ClosingJaws{0.012, 0.012, 0.1};
  moving_block_of(scene).tearing = Tearing{TearCriterion::max_elongation, 0.5};
  Bench bench(scene);
  const double low = kTop + kRadius - 0.001;
  for (int i = 0; i < 40; ++i) bench.tick(low, 0, 0, 0.6);
  for (int i = 0; i < 20; ++i) bench.tick(low, 0, 0, 0.05);
  EXPECT_TRUE(bench.organ().removed().empty());
  for (int i = 0; i < 500; ++i) {
    bench.tick(low + 1e-4 * i, 0, 0, 0.05);
    ASSERT_TRUE(bench.finite());
  }
  EXPECT_FALSE(bench.organ().removed().empty());
}

/// Force of a settled press of 3 mm at x, on all parts of the organ.
Vector3d settled_press(const Scene& scene, double x, const TetMesh& mesh = middle_block_mesh()) {
  Bench bench(scene, mesh);
  for (int i = 0; i < 3000; ++i) bench.tick(from_above(i, 800, kTop + kRadius + 0.001, kTop + kRadius - 0.003), x);
  EXPECT_TRUE(bench.finite());
  return bench.force();
}

TEST(DynamicOrgan, AHybridFeelsTheSameUnderATipWhicheverPartItTouches) {
  Scene whole = block_scene();
  moving_block_of(whole).dynamic.precision = Precision::float64;
  whole.contact = {.rule = ContactRule::barycentric, .friction = 0};
  for (const double x : {-0.01, 0.002, 0.015}) {
    const Vector3d wanted = settled_press(whole, x);
    EXPECT_LT(wanted.z(), -0.03);
    HybridSpec split;
    static_cast<MovingSpec&>(split) = moving_block_of(whole);
    split.hybrid.regions.push_back({{.box = Box{Vector3d(-1, -1, -1), Vector3d(0.0026, 1, 1)}}});
    Scene hybrid = whole;
    hybrid.bodies[0] = split;
    const Vector3d felt = settled_press(hybrid, x);
    EXPECT_LT((felt - wanted).norm(), 0.05 * wanted.norm())
        << "at x = " << x << ": " << felt.transpose() << " against " << wanted.transpose();
  }
}

TEST(DynamicOrgan, ACoarsePartJoinedAtTheSharedNodesIsHeldByTheFineOne) {
  HybridSpec joined;
  joined.hybrid.mesh = "coarse.msh";
  Scene scene = block_scene(joined);
  scene.contact = {.rule = ContactRule::barycentric, .friction = 0};
  moving_block_of(scene).fixed[0].where = {.indices = {},
                                           .box = Box{Vector3d(-1, -1, -1e-6), Vector3d(1, 1, 1e-6)},
                                           .group = ""};  // not the coarse mesh's bottom
  const TetMesh fine = make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.015}, {12, 12, 3});
  const TetMesh coarse = make_block({-0.03, -0.03, 0.015}, {0.03, 0.03, 0.03}, {6, 6, 2});
  Bench bench(scene, fine, coarse);
  EXPECT_EQ(bench.organ().condensed_part()->part().connection().size(), 49u);
  for (int i = 0; i < 2000; ++i) bench.tick(from_above(i, 600, kTop + kRadius + 0.001, kTop + kRadius - 0.003));
  ASSERT_TRUE(bench.finite());
  Scene alike = block_scene();
  alike.contact = scene.contact;
  const double whole = settled_press(alike, 0, make_block({-0.03, -0.03, 0}, {0.03, 0.03, 0.03}, {6, 6, 4})).z();
  EXPECT_NEAR(bench.force().z(), whole, 0.25 * std::abs(whole))
      << "the part below is finer and joined at fewer nodes, so softer";
  EXPECT_GT(bench.force().z(), whole);
  for (int i = 0; i < 1500; ++i) bench.tick(kTop + 0.03);
  EXPECT_LT(bench.organ().condensed_part()->part().gap(bench.organ().model()), 1e-5)
      << "at rest both sides lie on one another again";
}

TEST(DynamicOrgan, AnUnstableStepIsRefusedWithTheBound) {
  Scene scene = block_scene();
  moving_block_of(scene).dynamic.step = 0.1;
  try {
    Bench bench(scene);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("the bound is"), std::string::npos) << error.what();
  }
}

// Its node was gone for a while, or is a new one: the tool stands where the tissue has sprung back to.
TEST(DynamicOrgan, AToolThatComesAnewWithinTheTissueStrikesNoBlow) {
  Bench bench(block_scene());
  const double deep = kTop + kRadius - 0.004;
  for (int i = 0; i < 1000; ++i) bench.tick(from_above(i, 300, kTop + kRadius + 0.001, deep));
  const double held = bench.force().norm();
  ASSERT_GT(held, 0.05);
  bench.world().leave(0);
  for (int i = 0; i < 500; ++i) bench.world().tick();
  EXPECT_TRUE(bench.force().isZero(0));
  double before = 0, max_jump = 0, largest = 0;
  for (int i = 0; i < 1000; ++i) {
    bench.tick(deep);
    const double now = bench.force().norm();
    max_jump = std::max(max_jump, std::abs(now - before));
    largest = std::max(largest, now);
    before = now;
  }
  EXPECT_NEAR(before, held, 0.05 * held);  // friction remembers the way there
  EXPECT_LT(largest, 1.5 * held);
  EXPECT_LT(max_jump, 0.3 * held);
}

TEST(DynamicOrgan, RandomManipulationStaysFinite) {
  for (Scene scene : {block_scene(), block_scene(SpringMassSpec{})}) {
    std::get<ProbeSpec>(scene.tools[0].end).cautery = Cautery{0.0065};
    std::get<ProbeSpec>(scene.tools[0].end).jaws = ClosingJaws{};
    moving_block_of(scene).dynamic.gravity = {0, 0, -9.81};
    Bench bench(scene);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    double z = kTop + 0.02, x = 0, pedal = 0, grip = 1;
    for (int i = 0; i < 2500; ++i) {
      if (i % 50 == 0) pedal = unit(random) > 0.8, grip = unit(random) > 0.5 ? 1 : 0;
      z += 1e-3 * (unit(random) - 0.5 - 4 * (z - kTop));
      x += 1e-3 * (unit(random) - 0.5 - 4 * x);
      bench.tick(z, x, pedal, grip);
      ASSERT_TRUE(bench.finite()) << kind_of(scene.bodies[0]) << " at tick " << i;
    }
  }
}

}  // namespace
}  // namespace palpate
