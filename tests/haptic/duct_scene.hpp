#pragma once
#include "common/mesh/shell_generators.hpp"
#include "common/models/modal_shell/precompute.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/haptic_step.hpp"
#include "tests/haptic/block_scene.hpp"

namespace palpate::testing {

/// A straight duct along z from 0 to 40 mm, 9 mm wide, clamped at its far end, under tools whose trocars lie above it
/// (along +y): at depth d a tool's tip is 0.15 m - d above the axis, in the middle of the duct.
struct DuctScene {
  static constexpr double kRadius = kDuctRadius, kLength = kDuctLength, kThickness = 0.001;
  Scene scene;
  std::vector<Archive> archives;

  explicit DuctScene(int modes = 30) {
    const ShellMesh mesh = make_tube(kRadius, kLength, 16, 16);
    const ModalShellSpec duct = duct_body(kThickness, modes);
    scene.bodies.push_back(duct);
    archives.push_back(precompute(duct, mesh));
  }

  Tool& add_probe() {
    Tool tool;
    tool.name = "probe" + std::to_string(scene.tools.size());
    tool.pivot = {0, 0.15, kLength / 2};
    tool.axis = -Eigen::Vector3d::UnitY();
    tool.up = Eigen::Vector3d::UnitZ();
    std::get<ProbeSpec>(tool.end).radius = 0.003;
    tool.shaft_length = 0.02;
    tool.max_force = 100;
    tool.max_force_rate = 1e7;
    scene.tools.push_back(tool);
    return scene.tools.back();
  }

  Tool& add_forceps() {
    Tool& tool = add_probe();
    tool.end = ForcepsSpec{};
    tool.shaft_length = 0.2;
    return tool;
  }

  /// A catheter along the duct's axis that ends `ahead` [m] before the open mouth at z = 0.
  void add_catheter(double ahead = 0.004, int particles = 31) {
    CatheterSpec body;
    body.name = "catheter";
    body.material = {.young = 30e6, .poisson = 0.45, .density = 1100};
    body.catheter = {
        .inside = "duct", .tail = {0, 0, -0.06 - ahead}, .tip = {0, 0, -ahead}, .particles = particles, .sleeve = 0.02};
    scene.bodies.push_back(body);
    archives.push_back({});
  }
};

/// The dofs that put the tip (of a forceps: its joint) at p with the jaws open by `grip`.
inline ToolDofs duct_tip_at(const Tool& tool, const Eigen::Vector3d& p, double grip = 0, double roll = 0) {
  ToolDofs dofs = tip_at(tool, p, roll);
  dofs.grip = grip;
  return dofs;
}

}  // namespace palpate::testing
