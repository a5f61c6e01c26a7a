#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/touch_body.hpp"
#include "common/models/moving/local_part.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/tool_rig.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// One tick of the haptic loop as a function of the tools' degrees of freedom and of its own state: a loop over tools
/// and bodies. Tools move and their jaws work, bodies that move by themselves move, then tools meet the bodies, and the
/// hands get their forces. It allocates nothing, takes no lock and does no I/O after construction, and gives the same
/// bits for the same inputs on the same code path.
class HapticStep {
 public:
  /// One archive per body, read with ArchivePart::touchable; of those of moving tissue the header.
  HapticStep(const Scene& scene, const std::vector<Archive>& archives);
  ~HapticStep();

  int tools() const { return static_cast<int>(rigs_.size()); }
  int bodies() const { return bodies_; }
  double dt() const { return dt_; }  ///< [s] nominal period

  /// Sets the tools' poses before the first step. Throws std::runtime_error on one that is not a number, and naming
  /// tool and body if one starts in contact.
  void start(std::span<const ToolDofs> dofs);
  /// The same, where tools may go on from contacts that peers kept: then resume() and starts_inside().
  void place(std::span<const ToolDofs> dofs);
  /// Takes up what a peer kept of a tool's contacts, all of them; or none, and false, where one cannot be of this scene
  /// and of where the tool is, or the bodies cannot hold as many. Those of a tool that has resumed already, or is in no
  /// body, are left. With the last tool that starts within a body, the bodies come to rest under what was taken up.
  bool resume(const ContactState& kept);
  /// Names a tool that starts within a body without having resumed its contacts, and the body; empty: none.
  std::string starts_inside() const;

  void step(std::span<const ToolDofs> dofs);

  /// Moving tissue: what it can do, and what a tool feels of it.
  bool has_moving_tissue() const { return local_ != nullptr; }
  const TissueLimits& limits() const { return *limits_; }
  const LocalBody& local(int tool) const { return local_->of(tool); }
  /// The next steps use this model of the tissue near `tool`.
  void consume(int tool, const LocalModel& model) { local_->of(tool).consume(model); }
  /// The same for a message; false if it fits neither tools nor bodies of the scene.
  bool consume(const LocalContactModel& message);

  const ToolRig& rig(int tool) const { return *rigs_[tool]; }
  /// What the hand gets [N, N m], on the tool at its tip, world frame.
  const Eigen::Vector3d& force(int tool) const { return rigs_[tool]->output().force; }
  const Eigen::Vector3d& torque(int tool) const { return rigs_[tool]->output().torque; }
  std::uint32_t flags(int tool) const { return rigs_[tool]->output().flags; }
  const Eigen::Vector3d& press(int tool) const { return rigs_[tool]->output().press; }
  const Trocar& trocar(int tool) const { return rigs_[tool]->trocar(); }
  const Eigen::Isometry3d& pose(int tool) const { return rigs_[tool]->pose(); }
  double opening(int tool) const { return rigs_[tool]->end().opening(); }    ///< [rad] between a forceps' jaws
  double grip_torque(int tool) const { return rigs_[tool]->output().grip; }  ///< [N m] on the handle, opens the jaws
  /// [N m, N m, N, N m] force() and torque() along the tool's yaw, pitch, depth and roll.
  const Eigen::Vector4d& force_along_dofs(int tool) const { return rigs_[tool]->output().along; }
  const Eigen::Vector3d& trocar_force(int tool) const { return rigs_[tool]->output().trocar; }  ///< [N] on the shaft

  /// What the step knows of a body; null where the tissue moves, which tools feel by its local models.
  const BodyPart* part(int body) const;
  /// The contacts of a body that are solved for here.
  const ContactLaw& law(int body) const { return *part(body)->held(); }
  /// What the bodies tell others beside their contacts, each named as its message's body, with room for it.
  std::vector<BodyNews> news() const;
  /// Fills one of those messages, all but run, seq, step and time. Allocates nothing.
  void tell(BodyMessage& message) const;
  /// Every body that the tools meet here, in order.
  struct Entry {
    int body;
    std::string name;
    BodyPart* part;
  };
  std::span<const Entry> entries() const { return entries_; }

  /// [J] that all tools together have put into what they touch, by the forces that the hands really got.
  double energy() const { return passivity_.energy(); }
  std::uint64_t steps() const { return step_; }  ///< that are done
  void trip();                                   ///< fault from outside: the force ramps to zero

  /// Changing state as bytes, to start a replay from. save() leaves the factor forgotten, so that the run goes on
  /// bit for bit as one that begins with restore().
  std::size_t state_size() const;
  void save(std::span<std::uint8_t> to);
  void forget_factors();
  void state(State& s);                              ///< see save()
  void restore(std::span<const std::uint8_t> from);  ///< throws std::runtime_error on a state of another scene

 private:
  std::string inside(int tool) const;
  bool is_sound(std::uint32_t tool, const HeldContact& held) const;
  TouchContact contact_of(int tool, const HeldContact& held) const;
  void see_tools();
  void count_energy();
  bool meet_bodies();
  void give_forces(bool healthy);
  double largest_force() const;  ///< [N] of those that the hands get

  double dt_;
  int bodies_;
  std::unique_ptr<TissueLimits> limits_;        ///< what moving tissue can do
  std::vector<std::unique_ptr<ToolRig>> rigs_;  ///< whose ports passivity_ watches
  std::vector<std::unique_ptr<BodyPart>> parts_;
  std::vector<Entry> entries_;  ///< which body each of parts_ is, moving tissue's left out
  LocalPart* local_ = nullptr;  ///< one of parts_; null without moving tissue
  PassivityGuard passivity_;
  std::uint64_t step_ = 0;
  // What the bodies see of the tools in a step, and what they do to them: one after the other, as the bodies take them.
  std::vector<MovingTool> seen_;
  std::vector<ToolLoad> loads_;
};

}  // namespace palpate
