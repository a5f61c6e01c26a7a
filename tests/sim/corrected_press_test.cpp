#include <gtest/gtest.h>

#include "common/models/quasi_static/nonlinear.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "tools/rig/example_bodies.hpp"
#include "tools/rig/press_rig.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

/// A block whose left half is soft in what was fitted and whose right half is stiff, under a probe.
class CorrectedPress : public ::testing::TestWithParam<ContactRule> {
 protected:
  CorrectedPress() {
    scene_.contact.rule = GetParam();
    scene_.contact.friction = 0;
    archives_ = {precompute(block_of(scene_), block_mesh(10))};
    archives_[0].presses = {{{-0.02, 0, 0}, 0.004, {{0.1, 0.09}, {1, 0.7}}, {{1e-4, 0.9e-4}, {1e-3, 0.8e-3}}},
                            {{0.02, 0, 0}, 0.004, {{0.1, 0.11}, {1, 1.4}}, {{1e-4, 1.1e-4}, {1e-3, 1.3e-3}}}};
    corrected_ = scene_;
    block_of(corrected_).nonlinear = Nonlinear{NeoHookeanLaw{}};
  }

  /// A press of 3 mm at x [m], beside any node.
  static void press(PressRig& rig, double x) {
    const double radius = std::get<ProbeSpec>(rig.scene().tools[0].end).radius;
    const auto tip = [&](double depth) { return Vector3d(x, 0.003, radius - depth); };
    rig.start(tip(-1e-4));
    for (int i = 1; i <= 30; ++i) rig.step(tip(1e-4 * i));
  }

  Scene scene_ = block_scene(), corrected_;
  std::vector<Archive> archives_;
};

TEST_P(CorrectedPress, TheHandFeelsTheForceOfThePlaceThatIsPressed) {
  const BodyNonlinear law(archives_[0].presses);
  double before = 0;
  for (const double x : {-0.025, -0.005, 0.015}) {
    PressRig rig(corrected_, archives_);
    press(rig, x);
    PressPlace place;
    Vector3d linear = Vector3d::Zero();
    for (const NodalForce& f : rig.simulator().contacts(0).forces) {
      linear += Eigen::Map<const Vector3d>(f.force.data());
      place.add(archives_[0].surface.position[f.node], Eigen::Map<const Vector3d>(f.force.data()).norm());
    }
    EXPECT_NEAR(place.mean().x(), x, 0.006);
    const double scale = rig.force().norm() / linear.norm();
    EXPECT_NEAR(scale, law.at(place.mean()).force_scale(linear.norm()), 1e-3) << x;
    EXPECT_GT(scale, before) << x;
    before = scale;
  }
  EXPECT_GT(before, 1.05);
}

TEST_P(CorrectedPress, TheShapeWidensByTheLawOfThePlaceAlone) {
  PressRig rig(corrected_, archives_);
  press(rig, 0.021);
  ContactState state = rig.simulator().contacts(0);
  state.run = 1;
  for (Scene* scene : {&scene_, &corrected_}) scene->contact.rule = ContactRule::barycentric;  // no dent beside the law
  Deformer linear(scene_, archives_), corrected(corrected_, archives_);
  for (Deformer* deformer : {&linear, &corrected}) {
    ASSERT_TRUE(deformer->take(state));
    deformer->deform();
  }
  const auto &u = linear.surface(0).displacement, &v = corrected.surface(0).displacement;
  const Eigen::Vector3f press = Eigen::Map<const Vector3d>(state.press.data()).cast<float>();
  PressPlace place;
  for (const NodalForce& f : state.forces)
    place.add(archives_[0].surface.position[f.node], Eigen::Map<const Vector3d>(f.force.data()).norm());
  const QuasiNonlinear law = BodyNonlinear(archives_[0].presses).at(place.mean());
  double most = 0;
  for (std::size_t n = 0; n < u.size(); ++n) {
    EXPECT_NEAR(u[n].dot(press), v[n].dot(press), 1e-6);
    const float across = (u[n] - u[n].dot(press) * press).norm();
    if (across < 2e-5 || u[n] == v[n]) continue;  // hardly moved, or held
    const double scale = (v[n] - v[n].dot(press) * press).norm() / across;
    EXPECT_NEAR(scale, law.radial_scale(across), 1e-3);
    most = std::max(most, scale);
  }
  EXPECT_GT(most, 1.05);
}

// A patch presses on pressures of its own: no node is held under it, and all of them give way by the law.
TEST_P(CorrectedPress, NodesStayWhereAToolHoldsThem) {
  PressRig rig(corrected_, archives_);
  press(rig, 0.021);
  ContactState state = rig.simulator().contacts(0);
  state.run = 1;
  Deformer linear(scene_, archives_), corrected(corrected_, archives_);
  for (Deformer* deformer : {&linear, &corrected}) {
    ASSERT_TRUE(deformer->take(state));
    deformer->deform();
  }
  ASSERT_FALSE(state.forces.empty());
  int held = 0, aside = 0;
  const Eigen::Vector3f press = Eigen::Map<const Vector3d>(state.press.data()).cast<float>();
  for (const NodalForce& f : state.forces) {
    const Eigen::Vector3f &u = linear.surface(0).displacement[f.node], &v = corrected.surface(0).displacement[f.node];
    held += u == v;
    aside += (u - u.dot(press) * press).norm() > 2e-5f;
  }
  const auto loaded = static_cast<int>(state.forces.size());
  ASSERT_GT(aside, 0);
  EXPECT_EQ(held, GetParam() == ContactRule::patch ? loaded - aside : loaded);
}

TEST_P(CorrectedPress, WhatIsInJawsStays) {
  PressRig rig(corrected_, archives_);
  press(rig, 0.021);
  ContactState state = rig.simulator().contacts(0);
  state.run = 1;
  const std::uint32_t node =
      std::ranges::max_element(state.forces, {}, [](const NodalForce& f) { return std::abs(f.force[0]); })->node;
  const std::uint32_t part = state.contacts[0].sample;  // which has a patch, where patches are
  state.contacts.push_back(
      {.nodes = {node, node, node}, .weights = {1, 0, 0}, .normal = {0, 0, -1}, .sample = part, .sticking = kInJaws});
  Deformer linear(scene_, archives_), corrected(corrected_, archives_);
  for (Deformer* deformer : {&linear, &corrected}) {
    ASSERT_TRUE(deformer->take(state));
    deformer->deform();
  }
  const Eigen::Vector3f u = linear.surface(0).displacement[node];
  ASSERT_GT(std::hypot(u.x(), u.y()), 2e-5f);
  EXPECT_EQ(u, corrected.surface(0).displacement[node]);
}

INSTANTIATE_TEST_SUITE_P(Rules, CorrectedPress, ::testing::Values(ContactRule::barycentric, ContactRule::patch),
                         [](const auto& info) { return std::string(word_of(info.param)); });

}  // namespace
}  // namespace palpate
