#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/touch_body.hpp"
#include "common/models/catheter/catheter_body.hpp"
#include "common/models/catheter/task.hpp"
#include "common/models/modal_shell/modal_body.hpp"
#include "common/models/moving/local_body.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/forceps_hand.hpp"
#include "common/tool/kinematics.hpp"
#include "common/tool/passivity.hpp"
#include "common/tool/safety.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// A body that crosses the bus by its reduced state: modes, or particles.
struct ReducedBody {
  int body = 0;          ///< position in the scene's body list
  std::size_t size = 0;  ///< modes; particles
};

/// One tick of the haptic loop as a function of the tools' degrees of freedom and of its own state:
/// sense, collide, hold, force. Jaws close, catheters move against the walls as they stand, then tools meet the
/// bodies. It allocates nothing, takes no lock and does no I/O after construction, and gives the same bits for the
/// same inputs on the same code path.
class HapticStep {
 public:
  /// One archive per body, read with ArchivePart::touchable; those of dynamic bodies are not looked at.
  HapticStep(const Scene& scene, const std::vector<Archive>& archives);
  ~HapticStep();

  int tools() const { return static_cast<int>(moving_.size()); }
  int bodies() const { return static_cast<int>(bodies_.size()); }
  double dt() const { return dt_; }  ///< [s] nominal period

  /// Sets the tools' poses before the first step. Throws std::runtime_error naming tool and body if one starts in
  /// contact, unless `resuming` (a peer keeps this run's contacts).
  void start(std::span<const ToolDofs> dofs, bool resuming = false);
  /// Takes up a contact that a peer kept. Throws std::runtime_error if it does not fit this scene.
  void adopt(std::uint32_t tool, const HeldContact& contact);

  void step(std::span<const ToolDofs> dofs);

  /// Moving tissue: which bodies are dynamic, one entry per body, and what a tool feels of them.
  bool has_moving_tissue() const { return !local_.empty(); }
  std::span<const std::uint8_t> dynamic() const { return dynamic_; }
  const LocalBody& local(int tool) const { return *local_[tool]; }
  /// The next steps use this model of the tissue near `tool`.
  void consume(int tool, const LocalModel& model) { local_[tool]->consume(model); }
  /// The same for a message; false if it fits neither tools nor bodies of the scene.
  bool consume(const LocalContactModel& message);

  /// What the hand gets [N, N m], on the tool at its tip, world frame.
  const Eigen::Vector3d& force(int tool) const { return output_[tool].force; }
  const Eigen::Vector3d& torque(int tool) const { return output_[tool].torque; }
  std::uint32_t flags(int tool) const { return output_[tool].flags; }
  const Eigen::Vector3d& press(int tool) const { return output_[tool].press; }
  const Eigen::Isometry3d& pose(int tool) const { return moving_[tool].now; }
  double opening(int tool) const {
    return hands_[tool] ? hands_[tool]->opening() : 0.0;
  }                                                                  ///< [rad] between a forceps' jaws
  double grip_torque(int tool) const { return output_[tool].grip; }  ///< [N m] on the handle, opens the jaws
  const Eigen::Vector3d& trocar_force(int tool) const {
    return output_[tool].trocar;
  }  ///< [N] of the trocar on the shaft
  bool is_touch_body(int b) const { return bodies_[b] != nullptr; }
  const TouchBody& body(int b) const { return *bodies_[b]; }  ///< a quasi-static or modal one

  /// Bodies that move with inertia and whose state this node owns.
  std::span<const ReducedBody> modal_bodies() const { return modal_bodies_; }
  std::span<const ReducedBody> catheters() const { return catheter_bodies_; }
  bool is_modal(int b) const { return modal_[b] != nullptr; }
  const ModalBody& modal(int b) const { return *modal_[b]; }
  const CatheterBody& catheter(int b) const { return *catheters_[b]; }
  std::span<const Task> tasks() const { return tasks_; }  ///< one a catheter, in the order of catheters()
  /// [J] that all tools together have put into what they touch, by the forces that the hands really got.
  double energy() const { return passivity_.energy(); }
  void trip();  ///< fault from outside: the force ramps to zero

  /// Changing state as bytes, to start a replay from. save() leaves the factor forgotten, so that the run goes on
  /// bit for bit as one that begins with restore().
  std::size_t state_size() const;
  void save(std::span<std::uint8_t> to);
  void forget_factors();
  void restore(std::span<const std::uint8_t> from);  ///< throws std::runtime_error on a state of another scene

 private:
  struct Output {
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero(), press = Eigen::Vector3d::Zero();
    Eigen::Vector3d trocar = Eigen::Vector3d::Zero();
    double grip = 0;
    std::uint32_t flags = 0;
  };
  void count_energy();
  void limit_forces(std::span<const ToolDofs> dofs, bool healthy, std::uint32_t flags);
  bool sense(std::span<const ToolDofs> dofs);
  const char* part_name(int tool, int part) const;
  void build_catheters(const Scene& scene);
  void work_jaws(std::span<const ToolDofs> dofs);
  void work_forceps(std::span<const ToolDofs> dofs);
  bool move_catheters();
  void keep_tasks();
  template <class Visit>
  void visit_extras(Visit&& visit);

  double dt_;
  std::vector<Trocar> trocars_;
  std::vector<std::string> tool_names_, body_names_;
  std::vector<std::vector<ToolPart>> parts_, parts_before_;  ///< per tool; of a forceps they turn
  std::vector<double> shaft_length_, tool_compliance_;
  std::vector<MovingTool> moving_;
  std::vector<std::unique_ptr<TouchBody>> bodies_;        ///< null where the body is dynamic or a catheter
  std::vector<ModalBody*> modal_;                         ///< those of bodies_ that are; null else
  std::vector<std::unique_ptr<CatheterBody>> catheters_;  ///< null where the body is none
  std::vector<ModalBody*> ducts_;                         ///< per body: what a catheter is led into, null for none
  std::vector<ReducedBody> modal_bodies_, catheter_bodies_;
  std::vector<CatheterTool> catheter_tools_;
  std::vector<Eigen::Isometry3d> jaw_poses_;
  std::vector<Task> tasks_;
  std::vector<int> wall_contacts_;  ///< per catheter, in the last step
  std::vector<std::uint8_t> held_before_;
  std::vector<std::uint8_t> dynamic_;
  std::vector<std::unique_ptr<LocalBody>> local_;  ///< one per tool; none without a dynamic body
  std::uint64_t step_ = 0;
  PassivityGuard passivity_;
  std::vector<SafetyChain> safety_;
  std::vector<std::optional<ForcepsHand>> hands_;  ///< per tool; of those that are forceps
  std::vector<std::optional<ProbeJaws>> jaws_;     ///< per tool; of probes
  std::vector<std::uint8_t> jaws_closed_;
  std::vector<ToolLoad> loads_;
  std::vector<Output> output_;
  std::vector<PortMotion> motion_;  ///< per tool, of this step
  std::vector<PortForce> asked_;
  std::vector<double> handle_;  ///< [rad] per tool: the handle in the last step
};

}  // namespace palpate
