#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "common/sim/haptic_step.hpp"
#include "common/sim/local_models.hpp"

namespace palpate {

/// A scene with moving tissue as its haptic and its deformation node compute it, in lock step over a bus without delay.
/// Either may stop, or die and come back as another one.
class TwoNodes {
 public:
  static constexpr int kSettlingTicks = 4;  ///< that a deformation node does in the time of one

  /// One archive per body, read with ArchivePart::surface.
  TwoNodes(const Scene& scene, const std::vector<Archive>& archives);

  /// Where the tools are before the first step.
  void start(std::span<const ToolDofs> dofs);
  /// One tick of the haptic loop, and of the tissue where they are there.
  void step(std::span<const ToolDofs> dofs);

  void stop_tissue() { phase_ = Phase::gone; }  ///< SIGSTOP
  void continue_tissue() { phase_ = Phase::moving; }
  void kill_tissue() { phase_ = Phase::gone; }
  /// Another deformation node; what was gone stays gone.
  void restart_tissue();
  void kill_haptic() { haptic_.reset(); }
  /// Another haptic node, whose tools are where they are.
  void restart_haptic(std::span<const ToolDofs> dofs);

  /// What the tissue tells arrives so many ticks late.
  void delay(int ticks) { delay_ = static_cast<std::size_t>(ticks); }

  bool has_haptic() const { return haptic_ != nullptr; }
  HapticStep& haptic() { return *haptic_; }
  /// [N] on a tool, as its hand gets it: none without a haptic node.
  Eigen::Vector3d force(int tool) const;
  const DynamicWorld& world() const { return *world_; }
  int refused() const { return refused_; }  ///< models of the tissue that the haptic node did not take

 private:
  enum class Phase { gone, settling, moving };

  void make_tissue();
  void make_haptic(std::span<const ToolDofs> dofs);
  void tell_tissue(std::span<const ToolDofs> dofs);
  void settle();
  void tick();
  const LocalContactModel& describe(int tool);

  Scene scene_;
  std::vector<Archive> archives_;
  std::unique_ptr<HapticStep> haptic_;
  std::unique_ptr<DynamicWorld> world_;
  std::unique_ptr<LocalModels> models_;
  std::vector<LocalContactModel> model_;                  ///< the newest, per tool
  std::deque<std::vector<LocalContactModel>> under_way_;  ///< a tick each
  std::size_t delay_ = 0;
  int refused_ = 0;
  std::uint64_t haptic_run_ = 0, tissue_run_ = 0;
  Phase phase_ = Phase::gone;
};

}  // namespace palpate
