#include "common/contact/contact_law.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/haptic/synthetic_body.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

Anchor vertex(int node) {
  return {{node, node, node}, Vector3d::UnitX()};
}

class ContactLawTest : public ::testing::Test {
 protected:
  TouchContact press(const Anchor& anchor, double depth, const Vector3d& sideways = Vector3d::Zero()) const {
    TouchContact c;
    c.anchor = anchor;
    c.face = anchor.nodes[0] != anchor.nodes[1];
    c.normal = -Vector3d::UnitZ();
    c.target = anchor_position(anchor, archive_.surface.position) + depth * c.normal + sideways;
    c.plane = c.normal.dot(c.target);
    return c;
  }
  ContactLaw law(double friction, ContactLaw::Rule rule = ContactLaw::Rule::barycentric) const {
    return {{response_, archive_.surface.position}, rule, friction, 64};
  }
  Archive archive_ = testing::flat_patch(12, 0.01, 1e-2);
  Compliance<double> compliance_{archive_, Compliance<double>::Rows::touchable};
  CompliantResponse response_{compliance_};
};

TEST_F(ContactLawTest, FrictionlessContactsNeverPullAndNeverPenetrate) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> depth(-2e-3, 2e-3);
  for (int round = 0; round < 200; ++round) {
    ContactLaw frictionless = law(0);
    for (int node = round % 3; node < 144; node += 4) frictionless.add(press(vertex(node), depth(random)));
    const LawOutcome outcome = frictionless.solve();
    ASSERT_TRUE(outcome.converged) << "round " << round;
    for (const TouchContact& c : frictionless.contacts()) {
      const double force = c.force.dot(c.normal), gap = c.normal.dot(c.position) - c.plane;
      ASSERT_GE(force, 0);
      ASSERT_GE(gap, -2e-9);
      ASSERT_LT(force * gap, 1e-12);
    }
  }
}

TEST_F(ContactLawTest, FrictionStaysWithinItsCone) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> depth(-1e-3, 2e-3), side(-3e-3, 3e-3);
  for (int round = 0; round < 200; ++round) {
    ContactLaw rough = law(0.3);
    for (int node = round % 5; node < 144; node += 9)
      rough.add(press(vertex(node), depth(random), {side(random), side(random), 0}));
    const LawOutcome outcome = rough.solve();
    for (const TouchContact& c : rough.contacts()) {
      const double pressing = c.force.dot(c.normal);
      const double tangential = (c.force - pressing * c.normal).norm();
      ASSERT_GE(pressing, -1e-12);
      ASSERT_LE(tangential, 0.3 * pressing * 1.005 + 1e-9) << "round " << round << " converged " << outcome.converged;
    }
  }
}

TEST_F(ContactLawTest, ASmallSidewaysPullSticksAndALargeOneSlidesAgainstTheCone) {
  ContactLaw rough = law(0.5);
  rough.add(press(vertex(66), 1e-3, {1e-4, 0, 0}));
  rough.solve();
  EXPECT_EQ(rough.contacts()[0].touch, Touch::sticking);
  rough.contacts()[0].target += Vector3d(5e-3, 0, 0);
  rough.solve();
  const TouchContact& c = rough.contacts()[0];
  EXPECT_EQ(c.touch, Touch::sliding);
  EXPECT_NEAR(c.force.x(), 0.5 * -c.force.z(), 2e-3 * -c.force.z());
}

TEST_F(ContactLawTest, ASlidingContactSticksAgainWhenTheSlipTurnsRound) {
  ContactLaw rough = law(0.5);
  rough.add(press(vertex(66), 1e-3, {5e-3, 0, 0}));
  rough.solve();
  ASSERT_EQ(rough.contacts()[0].touch, Touch::sliding);
  TouchContact& c = rough.contacts()[0];
  c.target = c.position - Vector3d(1e-5, 0, 0);
  rough.solve();
  EXPECT_EQ(rough.contacts()[0].touch, Touch::sticking);
}

TEST_F(ContactLawTest, ReleasedContactsLeaveNoForce) {
  ContactLaw rough = law(0.3);
  rough.add(press(vertex(66), 1e-3));
  rough.solve();
  EXPECT_LT(rough.contacts()[0].force.z(), 0);
  TouchContact& c = rough.contacts()[0];
  c.target.z() = 1e-3;
  c.plane = c.normal.dot(c.target);
  rough.solve();
  EXPECT_EQ(rough.contacts()[0].touch, Touch::open);
  EXPECT_EQ(rough.contacts()[0].force.norm(), 0);
  int forces = 0;
  rough.for_each_nodal_force([&](int, int, const Vector3d&) { ++forces; });
  EXPECT_EQ(forces, 0);
}

TEST_F(ContactLawTest, BothRulesMoveTheTouchedPointExactlyAndTheAlphaRuleIsStiffer) {
  const Anchor inside{{70, 71, 83}, Vector3d(0.5, 0.2, 0.3)};
  ContactLaw exact = law(1.0), alpha = law(1.0, ContactLaw::Rule::alpha);
  exact.add(press(inside, 1e-3));
  alpha.add(press(inside, 1e-3));
  exact.solve();
  alpha.solve();
  EXPECT_NEAR(exact.contacts()[0].position.z(), -1e-3, 1e-12);
  EXPECT_NEAR(alpha.contacts()[0].position.z(), -1e-3, 1e-12);
  EXPECT_GT(-alpha.contacts()[0].force.z(), 1.02 * -exact.contacts()[0].force.z());
}

TEST_F(ContactLawTest, UnderTheAlphaRuleASharedVertexBelongsToTheOlderContact) {
  ContactLaw alpha = law(1.0, ContactLaw::Rule::alpha);
  alpha.add(press({{70, 71, 83}, Vector3d(0.4, 0.3, 0.3)}, 1e-3));
  alpha.add(press({{71, 84, 83}, Vector3d(0.3, 0.4, 0.3)}, 1e-3));
  EXPECT_EQ(alpha.point_forces(0).size(), 9u);
  EXPECT_EQ(alpha.point_forces(1).size(), 3u);
  EXPECT_TRUE(alpha.solve().finite);
}

TEST_F(ContactLawTest, ManyContactsAtOnePlaceStayFiniteAndBounded) {
  ContactLaw rough = law(0.3);
  for (int i = 0; i < 20; ++i) rough.add(press({{70, 71, 83}, Vector3d(0.3, 0.3, 0.4)}, 1e-3 * (i % 3)));
  const LawOutcome outcome = rough.solve();
  EXPECT_TRUE(outcome.finite);
  EXPECT_GT(outcome.raised, 0);
  Vector3d total = Vector3d::Zero();
  for (const TouchContact& c : rough.contacts()) total += c.force;
  EXPECT_TRUE(total.allFinite());
  EXPECT_LT(total.norm(), 5.0);  // one contact 2 mm deep takes about 0.25 N
}

TEST_F(ContactLawTest, WhatASoftToolHoldsGivesWayByItsComplianceTimesTheForce) {
  constexpr double softness = 3e-3;
  for (const double friction : {0.0, 5.0}) {
    ContactLaw soft = law(friction);
    for (const int node : {40, 66, 70}) {
      TouchContact c = press(vertex(node), 1e-3, {2e-4, -1e-4, 0});
      c.tool_point().softness = softness;
      soft.add(c);
    }
    ASSERT_TRUE(soft.solve().converged);
    for (const TouchContact& c : soft.contacts()) {
      ASSERT_GT(c.force.dot(c.normal), 0);
      if (friction > 0) {
        EXPECT_EQ(c.touch, Touch::sticking);
        EXPECT_LT((c.position - (c.target - softness * c.force)).norm(), 1e-12);
      }
      EXPECT_NEAR(c.normal.dot(c.position), c.plane - softness * c.force.dot(c.normal), 1e-12);
      EXPECT_LT((c.held_at() - c.position - softness * c.force).norm(), 1e-15);
    }
  }
}

TEST_F(ContactLawTest, ASlidingContactOfASoftToolRubsByMuTimesItsPressure) {
  ContactLaw soft = law(0.3);
  TouchContact c = press(vertex(66), 1e-3, {8e-3, 0, 0});
  c.tool_point().softness = 3e-3;
  soft.add(c);
  soft.solve();
  const TouchContact& slid = soft.contacts()[0];
  EXPECT_EQ(slid.touch, Touch::sliding);
  EXPECT_NEAR(slid.force.x(), 0.3 * -slid.force.z(), 2e-3 * -slid.force.z());
  EXPECT_NEAR(-slid.position.z(), 1e-3 - 3e-3 * -slid.force.z(), 1e-9);
}

TEST_F(ContactLawTest, UnderTheAlphaRuleASoftToolGivesWayToo) {
  ContactLaw rigid = law(1.0, ContactLaw::Rule::alpha), soft = law(1.0, ContactLaw::Rule::alpha);
  TouchContact c = press({{70, 71, 83}, Vector3d(0.5, 0.2, 0.3)}, 1e-3);
  rigid.add(c);
  c.tool_point().softness = 3e-3;
  soft.add(c);
  rigid.solve();
  soft.solve();
  EXPECT_LT(-soft.contacts()[0].force.z(), 0.9 * -rigid.contacts()[0].force.z());
  // The tissue's own displacement is that of the forces on its nodes.
  double z = 0;
  const Anchor& anchor = c.anchor;
  soft.for_each_nodal_force([&](int, int node, const Vector3d& f) {
    for (int v = 0; v < 3; ++v) z += anchor.weights[v] * compliance_.column(node, 2)[3 * anchor.nodes[v] + 2] * f.z();
  });
  EXPECT_NEAR(soft.contacts()[0].position.z(), z, 1e-12);
}

// Two bodies whose surfaces lie on each other, the upper one pushed down: at each pair of points the gap closes and
// both carry the same force, which a direct solve with both compliances gives.
TEST_F(ContactLawTest, TwoBodiesPressEachOtherWithOneForce) {
  const double depth = 1e-3;
  Archive upper = testing::flat_patch(12, 0.01, 3e-2);
  for (Vector3d& x : upper.surface.position) x.z() -= depth;
  const Compliance<double> upper_compliance{upper, Compliance<double>::Rows::touchable};
  const CompliantResponse upper_response{upper_compliance};
  const ContactBody body{response_, archive_.surface.position}, presses{upper_response, upper.surface.position};
  for (const double friction : {0.0, 0.3}) {
    ContactLaw law(body, ContactLaw::Rule::barycentric, friction, 16, presses);
    const std::array<int, 3> nodes{66, 70, 83};
    for (const int node : nodes) law.add({.by = vertex(node), .anchor = vertex(node), .normal = -Vector3d::UnitZ()});
    const LawOutcome outcome = law.solve();
    EXPECT_TRUE(outcome.converged);

    Eigen::Matrix3d normal;  // of the normal directions alone: friction has nothing to hold here
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        normal(i, j) = response_.block(vertex(nodes[i]), vertex(nodes[j]))(2, 2) +
                       upper_response.block(vertex(nodes[i]), vertex(nodes[j]))(2, 2);
    const Vector3d force = normal.inverse() * Vector3d::Constant(depth);
    Vector3d on_body = Vector3d::Zero(), on_upper = Vector3d::Zero();
    std::vector<Vector3d> moved = archive_.surface.position, moved_upper = upper.surface.position;
    law.for_each_nodal_force([&](int c, int node, const Vector3d& f) {
      EXPECT_NEAR(f.z(), -force[c], 1e-6 * force[c]);
      on_body += f;
      for (const int n : nodes) moved[n] += response_.block(vertex(n), vertex(node)) * f;
    });
    law.for_each_reaction([&](int, int node, const Vector3d& f) {
      on_upper += f;
      for (const int n : nodes) moved_upper[n] += upper_response.block(vertex(n), vertex(node)) * f;
    });
    EXPECT_LT((on_body + on_upper).norm(), 1e-12);
    EXPECT_GT(on_upper.z(), 0);
    for (const int n : nodes) EXPECT_NEAR(moved[n].z(), moved_upper[n].z(), 1e-9);
  }
}

}  // namespace
}  // namespace palpate
