#include "common/contact/held_points.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "common/geometry/dense_solvers.hpp"
#include "tests/haptic/synthetic_body.hpp"

namespace palpate {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Anchor at_vertex(int node) {
  return {{node, node, node}, Vector3d::UnitX()};
}

/// J C J^T by plain sums.
MatrixXd compliance_of(const std::vector<Anchor>& anchors, const Compliance<double>& c) {
  MatrixXd a = MatrixXd::Zero(3 * anchors.size(), 3 * anchors.size());
  for (std::size_t p = 0; p < anchors.size(); ++p)
    for (std::size_t q = 0; q < anchors.size(); ++q)
      for (int v = 0; v < 3; ++v)
        for (int w = 0; w < 3; ++w)
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
              a(3 * p + i, 3 * q + j) += anchors[p].weights[v] * anchors[q].weights[w] *
                                         c.column(anchors[q].nodes[w], j)[3 * anchors[p].nodes[v] + i];
  return a;
}

class HeldPointsTest : public ::testing::Test {
 protected:
  Archive archive_ = testing::flat_patch(12, 0.01, 1e-2);
  Compliance<double> compliance_{archive_, Compliance<double>::Rows::touchable};
  CompliantResponse response_{compliance_};
  std::mt19937 random_{7};
};

TEST_F(HeldPointsTest, FullyHeldPointsTakeTheForcesOfTheDirectInverse) {
  HeldPoints held(response_, 8);
  std::vector<Anchor> anchors{at_vertex(3), at_vertex(40), {{70, 71, 83}, Vector3d(0.2, 0.3, 0.5)}, at_vertex(141)};
  for (const Anchor& a : anchors) held.add(a);
  const std::vector<Hold> hold(4, Hold::all);
  const std::vector<Vector3d> normal(4, Vector3d::UnitZ());
  std::vector<Vector3d> target;
  VectorXd d(12);
  for (int p = 0; p < 4; ++p) d.segment<3>(3 * p) = target.emplace_back(Vector3d::Random() * 1e-3);
  VectorXd f = VectorXd::Zero(12);
  EXPECT_EQ(held.solve(hold, normal, target, f.data()), 0);
  const VectorXd expected = DenseCholesky(compliance_of(anchors, compliance_)).solve(d);
  EXPECT_LT((f - expected).norm(), 1e-12 * expected.norm());
}

TEST_F(HeldPointsTest, AnyHistoryOfAddingRemovingAndHoldingGivesTheForcesOfAFreshSolve) {
  HeldPoints held(response_, 24);
  std::vector<Anchor> anchors;
  std::vector<Hold> hold;
  std::uniform_int_distribution<int> node(0, 143), kind(0, 5), state(0, 2);
  for (int round = 0; round < 400; ++round) {
    const bool grow = anchors.size() < 4 || (anchors.size() < 24 && kind(random_) < 3);
    if (grow) {
      const int n = node(random_);
      bool present = false;
      for (const Anchor& a : anchors) present |= a.nodes[0] == n;
      if (present) continue;
      anchors.push_back(at_vertex(n));
      hold.push_back(static_cast<Hold>(state(random_)));
      held.add(anchors.back());
    } else {
      const int at = std::uniform_int_distribution<int>(0, static_cast<int>(anchors.size()) - 1)(random_);
      anchors.erase(anchors.begin() + at);
      hold.erase(hold.begin() + at);
      held.remove(at);
    }
    if (!hold.empty()) hold[round % hold.size()] = static_cast<Hold>(state(random_));

    const int m = static_cast<int>(anchors.size());
    std::vector<Vector3d> normal, target;
    for (int p = 0; p < m; ++p) {
      normal.push_back(Vector3d::Random().normalized());
      target.push_back(1e-3 * Vector3d::Random());
    }
    VectorXd f = VectorXd::Zero(3 * m);
    for (int p = 0; p < m; ++p)
      if (hold[p] == Hold::normal) f.segment<3>(3 * p) = normal[p].unitOrthogonal() * 0.01;
    const VectorXd given = f;
    held.solve(hold, normal, target, f.data());

    // Rows of what is held, checked by substitution.
    const VectorXd u = compliance_of(anchors, compliance_) * f;
    for (int p = 0; p < m; ++p) {
      const Vector3d miss = u.segment<3>(3 * p) - target[p], added = f.segment<3>(3 * p) - given.segment<3>(3 * p);
      if (hold[p] == Hold::all) {
        ASSERT_LT(miss.norm(), 1e-12) << "round " << round;
      }
      if (hold[p] == Hold::normal) {
        ASSERT_LT(std::abs(miss.dot(normal[p])), 1e-12) << "round " << round;
        ASSERT_LT((added - added.dot(normal[p]) * normal[p]).norm(), 1e-9);
      }
      if (hold[p] == Hold::none) {
        ASSERT_EQ(f.segment<3>(3 * p).norm(), 0);
      }
    }
  }
}

TEST_F(HeldPointsTest, CoincidentPointsWithContradictoryTargetsGetBoundedForces) {
  HeldPoints held(response_, 4);
  const Anchor a{{70, 71, 83}, Vector3d(0.2, 0.3, 0.5)};
  held.add(a);
  held.add(a);
  const std::vector<Hold> hold(2, Hold::all);
  const std::vector<Vector3d> normal(2, Vector3d::UnitZ()), target{Vector3d(0, 0, 1e-3), Vector3d(0, 0, -1e-3)};
  VectorXd f = VectorXd::Zero(6);
  EXPECT_GT(held.solve(hold, normal, target, f.data()), 0);
  HeldPoints single(response_, 1);
  single.add(a);
  VectorXd alone = VectorXd::Zero(3);
  single.solve(std::span(hold).first(1), std::span(normal).first(1), std::span(target).first(1), alone.data());
  EXPECT_TRUE(f.allFinite());
  EXPECT_LT(f.cwiseAbs().maxCoeff(), 2.1 / HeldPoints::kPivotShare * alone.cwiseAbs().maxCoeff());
}

TEST_F(HeldPointsTest, ASoftHoldGivesThePointsTargetLessSoftnessTimesForce) {
  const double softness[] = {0, 2e-3, 7e-3, 1e-3};
  HeldPoints held(response_, 8);
  std::vector<Anchor> anchors{at_vertex(3), at_vertex(40), {{70, 71, 83}, Vector3d(0.2, 0.3, 0.5)}, at_vertex(141)};
  held.add(at_vertex(80), ToolPoint{.softness = 5e-3});
  for (int p = 0; p < 4; ++p) held.add(anchors[p], ToolPoint{.softness = softness[p]});
  held.remove(0);  // the others keep their own
  const std::vector<Hold> hold{Hold::all, Hold::normal, Hold::all, Hold::normal};
  std::vector<Vector3d> normal(4, Vector3d(0.6, 0, 0.8)), target;
  for (int p = 0; p < 4; ++p) target.push_back(1e-3 * Vector3d::Random());
  VectorXd f = VectorXd::Zero(12);
  held.solve(hold, normal, target, f.data());
  const VectorXd tissue = compliance_of(anchors, compliance_) * f;
  for (int p = 0; p < 4; ++p) {
    const Vector3d miss = tissue.segment<3>(3 * p) - (target[p] - softness[p] * f.segment<3>(3 * p));
    EXPECT_LT(hold[p] == Hold::all ? miss.norm() : std::abs(miss.dot(normal[p])), 1e-12) << p;
  }
}

}  // namespace
}  // namespace palpate
