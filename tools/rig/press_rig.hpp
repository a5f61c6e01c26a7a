#pragma once
#include <array>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/simulator.hpp"
#include "tools/rig/tip_at.hpp"

namespace palpate {

/// [N] on the tissue, of all contacts with an organ but those by nodes with a hybrid's quasi-static part.
Eigen::Vector3d force_on_moving_part(const DynamicOrgan& organ);
/// The same with those.
Eigen::Vector3d force_on(const DynamicOrgan& organ);

/// Points of the haptic step's body that contacts hold: of one tool, or of all where it is -1.
int held_points(const HapticStep& haptic, int body, int tool = -1);

/// A scene whose tools are put by hand, tick by tick: what studies, stability cases, tests and benchmarks press bodies
/// with. step() moves the whole scene on; press() the part alone that owns the state of its tissue, as that part's node
/// does: the deformation node's world where tissue moves with inertia, the haptic step where it does not. A rig keeps
/// to one of the two.
class PressRig {
 public:
  /// One archive per body, with all its parts. Throws what sim::Simulator does: std::runtime_error, of a step that is
  /// not stable with its bound.
  PressRig(const Scene& scene, std::vector<Archive> archives);

  const Scene& scene() const { return simulator_.scene(); }
  const std::vector<Archive>& archives() const { return archives_; }
  double dt() const { return simulator_.dt(); }  ///< [s] of a tick

  /// Where the tools are before the first tick. Throws std::runtime_error if one starts in contact.
  void start(std::span<const ToolDofs> dofs);
  void step(std::span<const ToolDofs> dofs);
  void press(std::span<const ToolDofs> dofs);

  // The same of a scene with one tool, by the place of its tip [m].
  void start(const Eigen::Vector3d& tip) { start(std::array{tip_at(scene().tools[0], tip)}); }
  void step(const Eigen::Vector3d& tip) { step(std::array{tip_at(scene().tools[0], tip)}); }
  void press(const Eigen::Vector3d& tip) { press(std::array{tip_at(scene().tools[0], tip)}); }

  /// [N] on the tissue, of all tools together: its contacts' own where it moves, else against what the hands get.
  Eigen::Vector3d force() const;
  /// [m] of each surface node of a body.
  std::vector<Eigen::Vector3d> displacement(int body = 0) { return simulator_.displacement(body); }

  sim::Simulator& simulator() { return simulator_; }
  HapticStep& haptic() { return simulator_.haptic(); }
  const HapticStep& haptic() const { return simulator_.haptic(); }
  DynamicWorld& tissue() { return simulator_.tissue(); }
  const DynamicOrgan& organ() const { return simulator_.tissue().organ(0); }  ///< the first body of moving tissue

 private:
  const std::vector<Archive> archives_;
  sim::Simulator simulator_;
  std::vector<sim::ToolInput> inputs_;
};

}  // namespace palpate
