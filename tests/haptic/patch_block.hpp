#pragma once
#include "common/mesh/generators.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/scene/scene.hpp"

namespace palpate::testing {

/// A block of 16 x 16 x 8 radii of a tip, of cells of two radii, that is pressed by the patch rule; its top lies in the
/// plane z = 0, its base is fixed.
struct PatchBlock {
  static constexpr double kRadius = 0.006, kYoung = 6000, kPoisson = 0.3;

  Scene scene;  ///< without tools
  Archive archive;

  /// Quadratic tensors, from cells halved so often.
  explicit PatchBlock(int refine) {
    QuasiStaticSpec block;
    block.name = "block";
    block.material = {kYoung, kPoisson, 1000};
    block.fixed.push_back({.where = {.indices = {}, .box = {}, .group = "bottom"}});
    block.offline = Offline{.refine = refine, .element = FiniteElement::p2};
    const double side = 16 * kRadius;
    archive = precompute(block, make_block({-side / 2, -side / 2, -side / 2}, {side / 2, side / 2, 0}, {8, 8, 4}));
    scene.bodies.push_back(block);
    scene.contact.rule = ContactRule::patch;
  }

  /// A probe with that tip that comes down from above, `aside` [m] along x.
  static Tool probe(const std::string& name, double aside = 0) {
    Tool tool;
    tool.name = name;
    tool.pivot = {aside, 0, 0.3};
    tool.axis = -Eigen::Vector3d::UnitZ();
    tool.up = Eigen::Vector3d::UnitY();
    std::get<ProbeSpec>(tool.end).radius = kRadius;
    tool.max_force = 100;
    tool.max_force_rate = 1e6;
    return tool;
  }
};

}  // namespace palpate::testing
