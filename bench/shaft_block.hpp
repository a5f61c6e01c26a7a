#pragma once
#include <algorithm>
#include <vector>

#include "bench/touch_block.hpp"
#include "tools/rig/press_rig.hpp"

/// A block of 12 x 12 x 6 radii of a shaft, its top in the plane z = 0, its base fixed, and a shaft that is laid across
/// all of it, with its ends beyond the block's.
namespace palpate::bench {

inline constexpr double kShaftRadius = kTipRadius, kShaftBlockHalf = 6 * kShaftRadius;

/// Even edges of h [m] along the top's middle, `beside` [m] to both sides of it, and as deep; growing beyond.
inline TetMesh shaft_block_of_edges(double h, double beside = 2.5 * kShaftRadius) {
  const auto out = steps_outward(h, beside, kShaftBlockHalf);
  std::vector<double> along, across(out.rbegin(), out.rend() - 1), down(out.rbegin(), out.rend());
  const int cells = static_cast<int>(std::ceil(2 * kShaftBlockHalf / std::max(h, kShaftRadius / 2) - 1e-9));
  for (int i = 0; i <= cells; ++i) along.push_back(kShaftBlockHalf * (2.0 * i / cells - 1));
  for (double& y : across) y = -y;
  across.insert(across.end(), out.begin(), out.end());
  for (double& z : down) z = -z;
  return make_graded_block(along, across, down);
}

/// The block by linear tensors, touchable where the shaft comes.
inline QuasiStaticSpec shaft_block(double beside = 2.5 * kShaftRadius) {
  QuasiStaticSpec block = touch_block();
  block.offline = Offline{};
  block.touchable =
      NodeSelector{{.indices = {}, .box = Box{{-1, -beside - 1e-6, -1e-6}, {1, beside + 1e-6, 1}}, .group = {}}};
  return block;
}

/// That block under a shaft along x, which a far pivot leaves level.
inline Scene shaft_scene(const QuasiStaticSpec& block, ContactRule rule, double friction) {
  Scene scene = touch_scene(block, friction);
  scene.contact.rule = rule;
  Tool& tool = scene.tools[0];
  tool.pivot = {-20, 0, kShaftRadius};
  tool.axis = Eigen::Vector3d::UnitX();
  tool.up = Eigen::Vector3d::UnitZ();
  tool.shaft_radius = kShaftRadius;
  tool.shaft_length = 20 * kShaftRadius;
  return scene;
}

/// Where the tip is for the shaft to lie so far aside and along [m], at a depth [m].
inline Eigen::Vector3d shaft_tip(double aside, double along, double depth) {
  return {10 * kShaftRadius + along, aside, kShaftRadius - depth};
}

}  // namespace palpate::bench
