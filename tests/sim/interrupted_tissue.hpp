#pragma once
#include <memory>

#include "common/scene/ensure_archive.hpp"
#include "common/sim/haptic_step.hpp"
#include "common/sim/local_models.hpp"
#include "tests/sim/played_scenes.hpp"

namespace palpate::testing {

/// A haptic step and its moving tissue in lock step, as the two nodes do it over a bus without delay, whose tissue may
/// stop, or die and come back. One tool.
class InterruptedTissue {
 public:
  static constexpr int kSettlingTicks = 4;  ///< that a node does in the time of one

  InterruptedTissue(const Scene& scene, const std::vector<Archive>& archives)
      : scene_(scene), archives_(archives), haptic_(scene_, archives_) {
    make_tissue();
    phase_ = Phase::moving;
  }

  void start(const ToolDofs& dofs) { haptic_.start(std::array{dofs}); }

  /// One tick of the haptic loop, and of the tissue where it is there.
  void step(const ToolDofs& dofs) {
    haptic_.step(std::array{dofs});
    newest_ = {.tool = 0,
               .run = 1,
               .seq = haptic_.steps(),
               .step = haptic_.steps() - 1,
               .yaw = dofs.yaw,
               .pitch = dofs.pitch,
               .depth = dofs.depth,
               .roll = dofs.roll,
               .grip = dofs.grip,
               .opening = haptic_.opening(0),
               .holding = haptic_.rig(0).end().holding(),
               .pedal = dofs.pedal};
    if (phase_ == Phase::gone) return;
    world_->take(newest_);
    if (phase_ == Phase::settling) settle();
    if (phase_ == Phase::moving) tick();
  }

  void stop() { phase_ = Phase::gone; }  ///< SIGSTOP
  void go_on() { phase_ = Phase::moving; }
  /// SIGKILL, and later another one in its place; what was gone stays gone.
  void die() { phase_ = Phase::gone; }
  void come_back() {
    make_tissue();
    phase_ = Phase::settling;
  }

  HapticStep& haptic() { return haptic_; }
  const DynamicWorld& world() const { return *world_; }

 private:
  enum class Phase { gone, settling, moving };

  void make_tissue() {
    std::vector<std::uint32_t> removed;
    if (world_)
      for (const int t : world_->organ(0).removed()) removed.push_back(static_cast<std::uint32_t>(t));
    world_ = std::make_unique<DynamicWorld>(scene_, archives_);
    models_ = std::make_unique<LocalModels>(*world_, archives_, LocalStiffness::Worker::caller);
    world_->organ(0).begin_without(removed);
    ++run_;
    model_ = {};
  }
  void settle() {
    for (int i = 0; i < kSettlingTicks && phase_ == Phase::settling; ++i)
      if (world_->settle()) phase_ = Phase::moving;
  }
  void tick() {
    world_->tick();
    models_->refresh();
    if (!world_->tool(0).follows()) return;
    models_->describe(0, model_);
    model_.run = run_;
    ++model_.seq;
    haptic_.consume(model_);
  }

  Scene scene_;
  std::vector<Archive> archives_;
  HapticStep haptic_;
  std::unique_ptr<DynamicWorld> world_;
  std::unique_ptr<LocalModels> models_;
  LocalContactModel model_;
  ToolState newest_;
  std::uint64_t run_ = 0;
  Phase phase_ = Phase::gone;
};

}  // namespace palpate::testing
