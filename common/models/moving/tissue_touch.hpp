#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <vector>

#include "common/contact/cut_surface.hpp"
#include "common/contact/tool_contacts.hpp"
#include "common/dynamics/dynamic_model.hpp"
#include "common/models/moving/floating_part.hpp"
#include "common/models/moving/inertial_response.hpp"
#include "common/models/moving/tissue_patches.hpp"

namespace palpate {

/// Contacts of tools with tissue that moves with inertia. What the tools touch is found once a tick; the contacts are
/// solved in every step of the tissue, for its end: first it moves without them, then their forces, by dt^2 / m of the
/// touched nodes, put right where these have come. A step with contacts is a semi-implicit one, whose end they set
/// exactly, so that at rest the forces are those of the static problem, what is pressed leaves a step with the tool's
/// velocity, and no stiffness of contact limits the step. Where points slide they do so within the tick too: an anchor
/// that stood still while the tissue swings under it would feed the swing.
class TissueTouch {
 public:
  static constexpr int kMaxContacts = 32;

  /// `archive`: read with ArchivePart::surface; it and `settings` are looked at here alone. `still`: of a hybrid body,
  /// null for others. All else outlives this object.
  TissueTouch(const Archive& archive, const ElasticMesh& mesh, const CutMesh& topology, CutSurface& surface,
              DynamicModel& model, CondensedTouch* still, const StepSettings& settings);

  /// Of the last tick: all that pressed in it, those that have let go as well, with the tick's mean normal.
  std::span<const TouchContact> contacts() const { return all_; }
  /// Whether tools touch the tissue, or nearly do, so that its steps are to be step()'s.
  bool touched() const { return !law_.contacts().empty() || (patches_ && patches_->laid()); }

  /// The same of one tool.
  bool lies_on(int tool) const;
  /// Whether tissue is led out of it.
  bool leads_in(int tool) const { return patches_ && patches_->leads_in(tool); }

  /// Once a tick of steps of `dt` [s]: which points the tools' parts touch. Contacts that go on keep where they stick.
  /// Returns what cells of patches did to nodes that have gone over a rim, until the next call: to let it fade is for
  /// the caller.
  std::span<const PatchForce> find(std::span<const MovingTool> tools, double dt);
  /// Forgets what a tool touches, its jaws' hold as well.
  void drop_tool(int tool);
  ToolContacts& search() { return contacts_; }
  /// Whether its jaws hold something of the body, of either part of a hybrid.
  bool grasping(int tool) const;
  /// What jaws hold. `tools`: as they are at the beginning and end of a step. Valid until the next call.
  std::span<const JawHold> held(std::span<const MovingTool> tools);

  /// One step of `dt` [s], as in find(), of the tissue with contacts. `tools`: as they are at its beginning and end.
  void step(std::span<const MovingTool> tools, double dt);
  /// After the last step of a tick of `dt` [s]: the contacts' forces become the tick's own, their impulses over its
  /// length; a single step's force of an impact grows as the step gets shorter. Contacts that have gone are dropped.
  void end_tick(std::span<const MovingTool> tools, double dt);
  /// After a cut: contacts on what is gone leave, and the tools feel less and less of what they were; the masses of
  /// what is left have changed. Returns what they did to nodes, until the next call: to let it fade is for the caller.
  std::span<const PatchForce> follow_cut(const CutMesh& topology);

  void forget_factor();
  void state(State& s, std::span<const MovingTool> tools);

 private:
  /// What pressed tissue that has been cut away, or has gone over a rim.
  struct Leaver {
    ToolPoint by;
    Anchor anchor;
    bool grasped = false;
    int ticks_left = 0;
    Eigen::Vector3d normal, force, at;  ///< force [N] on the tissue when it went, at [m] the place on the tool now
  };

  bool passed(const TouchContact& contact, const MovingTool& tool) const;
  template <class Gone>
  void drop_where(Gone&& gone);
  void leave(const TouchContact& contact);
  TissuePatches::Loose loose() {
    return {loose_, [this](const TouchContact& c) { leave(c); }};
  }
  void tell(const Leaver& leaver);
  void fade(std::span<const MovingTool> tools);
  void leavers_state(State& s, std::span<const MovingTool> tools);
  void follow_response(double dt);
  void gather();
  void solve(std::span<const MovingTool> tools);
  void lead_out(TouchContact& contact, const MovingTool& tool) const;
  void put_right(double dt);

  const ElasticMesh& mesh_;
  const CondensedTouch* still_;
  DynamicModel& model_;
  CutSurface& surface_;
  std::vector<Eigen::Vector3d> free_;   ///< [m] per node: where it is at a step's end without contacts
  std::vector<Eigen::Vector3d> aimed_;  ///< [m] per contact: its target, however deep it lies within the tool
  InertialResponse response_;
  ContactLaw law_;
  std::unique_ptr<TissuePatches> patches_;  ///< null: tips touch as everything else does
  ToolContacts contacts_;
  std::vector<TouchContact> all_;
  std::vector<JawHold> holds_;
  double passed_;  ///< [m] behind a part's surface, where tissue that it pressed is no more under it
  int fading_ticks_;
  std::size_t max_leavers_;
  std::vector<Leaver> leavers_;
  std::vector<PatchForce> loose_;  ///< [N] of the last cut or find()
  double dt_ = 0;                  ///< [s] of the step that the response is for
};

}  // namespace palpate
