#pragma once
#include <algorithm>
#include <cmath>

#include "common/mesh/generators.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/scene/scene.hpp"

/// A block of 16 x 16 x 8 radii of a tip, its top in the plane z = 0, its base fixed: what a contact is compared with
/// Hertz on.
namespace palpate::bench {

inline constexpr double kTipRadius = 0.006, kBlockYoung = 6000, kBlockPoisson = 0.3;

/// [N] Hertz's force of a rigid ball on a half-space.
inline double hertz(double depth) {
  return 4.0 / 3 * kBlockYoung / (1 - kBlockPoisson * kBlockPoisson) * std::sqrt(kTipRadius) * std::pow(depth, 1.5);
}

/// Coordinates from the middle outwards [m] to `end`: even steps of h where they are coarse or not beyond `core`, steps
/// that grow by about a third each beyond.
inline std::vector<double> steps_outward(double h, double core, double end) {
  std::vector<double> at{0};
  const double even = 8 * h >= end ? end : core;
  while (at.back() < even - 1e-9) at.push_back(at.back() + h);
  const std::size_t grown = at.size();
  for (double step = 4.0 / 3 * h; at.back() < end - 1e-9; step *= 4.0 / 3) at.push_back(at.back() + step);
  if (grown == at.size()) return at;
  const double from = at[grown - 1], share = (end - from) / (at.back() - from);
  for (std::size_t i = grown; i < at.size(); ++i) at[i] = from + share * (at[i] - from);
  return at;
}

/// Edges of h [m] under the tip.
inline TetMesh block_of_edges(double h) {
  const double half = 8 * kTipRadius;
  const auto out = steps_outward(h, 1.3 * kTipRadius + h, half);
  std::vector<double> across(out.rbegin(), out.rend() - 1), down(out.rbegin(), out.rend());
  for (double& x : across) x = -x;
  across.insert(across.end(), out.begin(), out.end());
  for (double& z : down) z = -z;
  return make_graded_block(across, across, down);
}

/// The block as the liver of the example is: pressed by a patch, quadratic tensors.
inline QuasiStaticSpec touch_block(int refine = 0) {
  QuasiStaticSpec block;
  block.name = "block";
  block.material = {kBlockYoung, kBlockPoisson, 1000};
  block.fixed.push_back({.where = {.indices = {}, .box = {}, .group = "bottom"}});
  block.offline = Offline{.refine = refine, .element = FiniteElement::p2};
  return block;
}

/// That block alone under a ball that comes down from above; nothing limits its force.
inline Scene touch_scene(const QuasiStaticSpec& block, double friction) {
  Scene scene;
  scene.bodies.push_back(block);
  scene.contact.rule = ContactRule::patch;
  scene.contact.friction = friction;
  scene.passivity.controller = false;
  Tool ball;
  ball.name = "ball";
  ball.pivot = {0, 0, 0.3};
  ball.shaft_radius = 0.3 * kTipRadius;
  ball.shaft_length = 0.4 * kTipRadius;
  std::get<ProbeSpec>(ball.end).radius = kTipRadius;
  ball.max_force = 1e9;
  ball.max_force_rate = 1e15;
  scene.tools.push_back(ball);
  return scene;
}

}  // namespace palpate::bench
