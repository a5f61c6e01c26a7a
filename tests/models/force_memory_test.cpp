#include "common/models/quasi_static/force_memory.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/haptic/synthetic_body.hpp"
#include "tests/tool/count_allocations.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kDt = 1e-3;
constexpr int kSide = 9, kNodes = kSide * kSide;
const Relaxation kRelaxation{{0.02, 0.3}, {0.3, 0.4}};

struct Force {
  int node;
  Vector3d force;
};
using Forces = std::vector<Force>;

/// A patch of nodes that relaxes, and its memory; `most` nodes carry force at once.
class OneNode : public Stateful<OneNode> {
 public:
  explicit OneNode(std::size_t most) : softened_(make()), memory_(step_, softened_, most) {}

  void step(const Forces& forces) {
    memory_.begin();
    for (const auto& [node, force] : forces) memory_.add(node, force);
    memory_.end();
  }
  /// [m] of all nodes.
  std::vector<Vector3d> displacement(Moment moment) const {
    std::vector<int> nodes(kNodes);
    for (int n = 0; n < kNodes; ++n) nodes[n] = n;
    std::vector<Vector3d> u(kNodes, Vector3d::Zero());
    memory_.for_each_load(moment, [&](int node, const Vector3d& load) {
      for (int n = 0; n < kNodes; ++n) u[n] += moved(n, node, load);
    });
    memory_.add_faded(moment, nodes, {u.data()->data(), 3 * u.size()});
    return u;
  }
  Vector3d moved(int n, int by, const Vector3d& load) const {
    Vector3d u = Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis)
      u += load[axis] * Eigen::Map<const Vector3d>(softened_.column(by, axis) + 3 * n);
    return u;
  }
  const CreepStep& creep() const { return step_; }
  const ForceMemory& memory() const { return memory_; }
  void state(State& s) { memory_.state(s); }

 private:
  static Compliance<double> make() {
    Compliance<double> c(testing::flat_patch(kSide, 0.01, 1e-3), Compliance<double>::Rows::touchable);
    c.scale(CreepStep(kRelaxation, kDt).instant());
    return c;
  }

  const CreepStep step_{kRelaxation, kDt};
  const Compliance<double> softened_;
  ForceMemory memory_;
};

/// The same with one full history a node, which forgets nothing.
class Reference {
 public:
  void step(const OneNode& body, const Forces& forces) {
    for (LoadTrace& t : traces_) t.before = t.force, t.force.setZero();
    for (const auto& [node, force] : forces) traces_[node].force += force;
    for (LoadTrace& t : traces_) t.follow(body.creep());
  }
  std::vector<Vector3d> displacement(const OneNode& body, Moment moment) const {
    std::vector<Vector3d> u(kNodes, Vector3d::Zero());
    for (int by = 0; by < kNodes; ++by)
      for (int n = 0; n < kNodes; ++n)
        u[n] += body.moved(n, by, traces_[by].load(body.creep(), moment) / body.creep().instant());
    return u;
  }

 private:
  std::vector<LoadTrace> traces_ = std::vector<LoadTrace>(kNodes);
};

void expect_same(const std::vector<Vector3d>& u, const std::vector<Vector3d>& expected) {
  double largest = 0, worst = 0;
  for (int n = 0; n < kNodes; ++n) {
    largest = std::max(largest, expected[n].norm());
    worst = std::max(worst, (u[n] - expected[n]).norm());
  }
  EXPECT_LE(worst, 1e-11 * largest + 1e-14);
}

/// Forces on a few nodes that wander over the patch, and rest.
Forces wandering(std::mt19937& random, int step, std::size_t most) {
  Forces forces;
  if (step % 400 > 250) return forces;
  const int first = step / 7 * 5;
  for (std::size_t i = 0; i < most; ++i) {
    const auto part = [&] { return 1e-3 * static_cast<double>(random() % 2000) - 1; };
    forces.push_back({(first + 11 * static_cast<int>(i)) % kNodes, {part(), part(), part()}});
  }
  return forces;
}

TEST(ForceMemory, ForgetsNothingOfTheShapeHoweverFewNodesItFollows) {
  for (const std::size_t most : {1u, 2u, 6u, 40u}) {
    SCOPED_TRACE(most);
    std::mt19937 random(7);
    OneNode body(most);
    Reference reference;
    for (int i = 0; i < 1500; ++i) {
      const Forces forces = wandering(random, i, most);
      body.step(forces);
      reference.step(body, forces);
      if (i % 37 != 0) continue;
      SCOPED_TRACE(i);
      for (const Moment moment : {Moment::now, Moment::ahead})
        expect_same(body.displacement(moment), reference.displacement(body, moment));
    }
  }
}

TEST(ForceMemory, CreepsUnderAForceThatStaysByTheClosedForm) {
  OneNode body(1);
  const Vector3d force(0.1, 0.2, -1);
  const Vector3d elastic = body.moved(13, 40, force) / body.creep().instant();
  for (int n = 1; n <= 2000; ++n) {
    body.step({{40, force}});
    double expected = 1;  // of a force that comes evenly within the first step
    for (const CreepTerm& term : creep_terms(kRelaxation)) {
      const double steps = kDt / term.time;
      expected += term.gain * (1 - std::exp(-n * steps) * std::expm1(steps) / steps);
    }
    EXPECT_LT((body.displacement(Moment::now)[13] - expected * elastic).norm(), 1e-9 * elastic.norm()) << n;
  }
}

TEST(ForceMemory, ComesBackToRest) {
  OneNode body(1);
  for (int n = 0; n < 500; ++n) body.step({{40, {0, 0, -1}}});
  const double pressed = body.displacement(Moment::now)[40].norm();
  for (int n = 0; n < 500; ++n) body.step({});
  const double left = body.displacement(Moment::now)[40].norm();
  EXPECT_GT(left, 0.1 * pressed);
  for (int n = 0; n < 80000; ++n) body.step({});
  EXPECT_EQ(body.displacement(Moment::now)[40].norm(), 0);
  int loads = 0;
  body.memory().for_each_creep_load([&](int, const Vector3d&) { ++loads; });
  EXPECT_EQ(loads, 0) << "and nothing is left to tell";
}

TEST(ForceMemory, TellsLoadsThatPutTheNodesWhereTheyAre) {
  std::mt19937 random(3);
  OneNode body(4);
  for (int i = 0; i < 300; ++i) body.step(wandering(random, i, 4));
  std::vector<Vector3d> told(kNodes, Vector3d::Zero());
  body.memory().for_each_creep_load([&](int node, const Vector3d& load) {
    for (int n = 0; n < kNodes; ++n) told[n] += body.moved(n, node, load / body.creep().instant());
  });
  expect_same(told, body.displacement(Moment::now));  // no force at that step
}

TEST(ForceMemory, GoesOnBitForBitFromASavedState) {
  std::mt19937 random(5);
  OneNode body(3), other(3);
  for (int i = 0; i < 700; ++i) body.step(wandering(random, i, 3));
  std::vector<std::uint8_t> state(body.state_size());
  body.save(state.data());
  other.restore(state.data());
  for (int i = 700; i < 900; ++i) {
    const Forces forces = wandering(random, i, 3);
    body.step(forces);
    other.step(forces);
    ASSERT_EQ(body.displacement(Moment::ahead), other.displacement(Moment::ahead)) << i;
  }
}

TEST(ForceMemory, TakesNoMemoryFromTheSystem) {
  std::mt19937 random(5);
  OneNode body(3);
  std::vector<Forces> forces;
  for (int i = 0; i < 1000; ++i) forces.push_back(wandering(random, i, 3));
  const long before = allocations();
  for (const Forces& f : forces) body.step(f);
  EXPECT_EQ(allocations(), before);
}

}  // namespace
}  // namespace palpate
