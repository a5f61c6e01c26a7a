#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/deformer.hpp"
#include "common/sim/dynamic_world.hpp"
#include "common/sim/haptic_step.hpp"
#include "common/sim/local_models.hpp"
#include "common/sim/step_messages.hpp"
#include "idl/messages.hpp"

namespace palpate::sim {

/// What one tool's device gives for a step.
using ToolInput = DeviceSample;

/// What a step leaves of one tool, and what its device is to give the hand.
struct ToolView {
  Eigen::Isometry3d pose;        ///< tip frame, world
  Eigen::Vector3d force;         ///< [N] on the tool at its tip, world
  Eigen::Vector3d torque;        ///< [N m] likewise, about the tip
  Eigen::Vector3d trocar_force;  ///< [N] of the trocar on the shaft, world
  double opening = 0;            ///< [rad] between a forceps' jaws
  double grip_torque = 0;        ///< [N m] on the handle, opens the jaws
  std::uint32_t flags = 0;       ///< bits of ForceFlag
};

/// Tetrahedra that a body has lost in the last step.
struct ChangeView {
  int body = 0;
  RemovalCause cause = cut;
  std::span<const int> removed;  ///< numbers in the archive, in order of removal
};

/// One body's visible surface, per node of its surface map.
struct SurfaceView {
  Eigen::Vector3d origin;                     ///< [m] world, near the body
  std::span<const Eigen::Vector3f> position;  ///< [m] world, from the origin on
  std::span<const Eigen::Vector3f> normal;    ///< unit, outward
};

/// A scene with all that owns state in it: tools and what they touch, moving tissue, shapes. A step is one haptic tick
/// of everything in lock step: forces, tissue, then the local contact models that the next step's forces use. It is a
/// function of the inputs and of its own state; no thread, no clock, no bus. The same inputs give the same bits on one
/// code path.
class Simulator {
 public:
  static constexpr std::uint64_t kRun = 1;  ///< in its messages: it is one start of a haptic loop and of the tissue

  /// One archive per body, read with ArchivePart::surface. Throws std::runtime_error if the scene cannot be run.
  Simulator(const Scene& scene, const std::vector<Archive>& archives);
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  const Scene& scene() const { return scene_; }
  int tools() const { return haptic_.tools(); }
  int bodies() const { return haptic_.bodies(); }
  double dt() const { return haptic_.dt(); }      ///< [s] of a step
  std::uint64_t steps() const { return steps_; }  ///< done so far

  /// Sets the tools' poses before the first step. Throws std::runtime_error if one starts in contact.
  void start(std::span<const ToolInput> inputs);
  /// One tick; one input per tool.
  void step(std::span<const ToolInput> inputs);

  // What the last step left.
  ToolView tool(int t) const;
  double energy() const { return haptic_.energy(); }  ///< [J] that all tools have put into what they touch
  const ContactState& contacts(int tool) const { return contacts_[tool]; }
  /// As the haptic loop would hand it to its publisher; times count from the first step.
  const StepRecord& record() const { return record_; }
  /// What the next step will feel of moving tissue near a tool; empty without any.
  const LocalContactModel& local_model(int tool) const { return models_[tool]; }
  std::vector<TaskRecord> tasks() const { return task_records(haptic_); }
  std::vector<ChangeView> changes() const;
  /// Rebuilt when it is asked for, and valid until the next call or step. Walls and catheters are shown
  /// as they were in the newest of every kShapeInterval steps.
  SurfaceView surface(int body);
  /// [m] of each node of a body's surface map, as its owner has it now; surface() shows that too until the next step.
  std::vector<Eigen::Vector3d> displacement(int body);

  // Its parts, to look at, or to be moved on alone where a part's own time or forces are wanted: the others then stay
  // behind.
  const HapticStep& haptic() const { return haptic_; }
  const DynamicWorld& tissue() const { return world_; }
  HapticStep& haptic() { return haptic_; }
  DynamicWorld& tissue() { return world_; }
  LocalModels& local_models() { return local_models_; }

  /// The whole state as bytes. What is kept of earlier solutions only to be faster is forgotten, so that the run goes
  /// on bit for bit as one that begins with restore().
  std::vector<std::uint8_t> save();
  /// Before the first step of another one of the same scene. Throws std::runtime_error on a state that does not fit.
  void restore(std::span<const std::uint8_t> from);
  /// XXH3 of what the last step left: tools, forces, contacts, tissue, walls and catheters.
  std::uint64_t hash() const;

 private:
  void forget_factors();
  void state(State& s);
  void move_tissue();
  void show_now();
  int organ_of(int body) const;  ///< its place among the tissue's; -1 where the haptic step owns it

  const Scene scene_;  // the tissue refers to it
  HapticStep haptic_;
  DynamicWorld world_;
  LocalModels local_models_;
  Deformer deformer_;
  std::uint64_t steps_ = 0;
  std::vector<ToolDofs> dofs_;
  StepRecord record_{};
  std::vector<ContactState> contacts_;              ///< per tool
  std::vector<LocalContactModel> models_;           ///< per tool
  std::vector<Eigen::Vector3f> position_, normal_;  ///< of the moving body that surface() was last asked for
};

}  // namespace palpate::sim
