#pragma once
#include <memory>
#include <vector>

#include "common/contact/body_part.hpp"
#include "common/contact/patch/patch.hpp"
#include "common/contact/step_settings.hpp"

namespace palpate {

/// The patches of tools on one body at rest under its loads: of probes' tips, and of shafts where the body does not
/// relax. Nothing is allocated after construction.
class PatchTouch {
 public:
  /// On so many nodes the body feels a patch: on more of them it presses where triangles are finer than a fifth of the
  /// part's radius, and what the outermost carry the next ones take over. The patch itself knows all of its nodes.
  static constexpr int kMaxForces = 64;

  /// `map` and `compliance` outlive this object; `half_space`: the material at the surface; `resolved`: see
  /// NearField. `creep`: of tissue that
  /// relaxes; compliance and material are softer by its instant() then.
  PatchTouch(const SurfaceMap& map, const Compliance<double>& compliance, const HalfSpace& half_space,
             const StepSettings& settings, double resolved, const std::optional<CreepStep>& creep = {});

  std::size_t parts() const { return parts_.size(); }
  /// Whether a part has a patch.
  bool has(int tool, int part) const;

  /// Visits (tool, node, force [N] on the tissue).
  using VisitForce = BodyPart::VisitForce;
  void for_each_force(const VisitForce& visit) const;
  /// [m] of a node by all patches.
  Eigen::Vector3d displacement(int node) const;

  /// Fills what past forces do to nodes [m], three entries a node.
  using Past = std::function<void(std::span<const int> nodes, std::span<double> displacement)>;
  /// The body that the patches lie on, beside them.
  struct Beside {
    std::function<void(const VisitForce&)> others;  ///< visits what else acts on it
    std::function<bool(int tool)> holds;            ///< jaws of the tool hold it: then they touch, and no patch does
    Past past = {};                                 ///< of tissue that relaxes
  };
  /// Solves for the forces of one step. False if pressures of a patch did not settle: what it gives then is bounded.
  bool touch(std::span<const MovingTool> tools, const Beside& beside);
  /// Sum over a tool's patches of their pressures' forces [N] on the tissue, without shear.
  Eigen::Vector3d pressing(int tool) const;
  /// Adds what they do to the tools.
  void load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const;

  /// Visits the patches that touch as one contact each.
  void for_each_contact(const BodyPart::VisitContact& visit) const;
  /// Goes on from a contact that a peer kept, of a part that has a patch.
  void adopt(const TouchContact& contact);

  void state(State& s);

 private:
  struct Part {
    int tool, part;
    Patch patch;
    std::vector<PatchForce> forces;  ///< on the body
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    bool left = false;  ///< in the last step, what it touched before
    double ease = 0;    ///< [m] that it stands too deep, and is led out of
  };

  std::span<const int> lay(Part& own, const Patch::Ground& ground, const MovingTool& tool) const;
  std::span<const int> press(Part& own, const MovingTool& tool, const Beside& beside);
  void load_body(Part& part);
  void add_displacement(int from, const Eigen::Vector3d& force, std::span<const int> nodes);
  void meet_others(Part& own, std::span<const int> nodes, bool relaxes);
  void remember(Part& part, std::span<const int> nodes);

  const Compliance<double>& compliance_;
  double friction_;
  double way_out_;  ///< [m] within a step
  SmoothSurface surface_;
  std::unique_ptr<NearField> near_field_;
  PatchGrids grids_;
  std::vector<Part> parts_;
  std::vector<Eigen::Vector3d> moved_;
};

}  // namespace palpate
