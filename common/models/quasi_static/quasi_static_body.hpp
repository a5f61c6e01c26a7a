#pragma once
#include <memory>
#include <optional>

#include "common/archive/load_sum.hpp"
#include "common/contact/patch/patch_touch.hpp"
#include "common/contact/touch_body.hpp"
#include "common/models/quasi_static/force_memory.hpp"
#include "common/models/quasi_static/nonlinear.hpp"

namespace palpate {

/// A body without inertia: its shape follows from the contact forces by superposition of its tensors (TVCG99 sec. 4),
/// and where it relaxes from those of the past too: contacts then meet a body that is softer by what it creeps within a
/// step, and whose shape without them is what the past has left.
class QuasiStaticBody : public TouchBody {
 public:
  QuasiStaticBody(const Archive& archive, const QuasiStaticSpec& body, const StepSettings& settings);

  void update_surface(std::span<const MovingTool> tools) override;
  LawOutcome hold(std::span<const MovingTool> tools) override;
  void for_each_contact(const VisitContact& visit) const override;
  void for_each_force(const VisitForce& visit) const override;
  Capacity capacity() const override;
  bool fits(const MovingTool& tool, std::span<const TouchContact> contacts) const override;
  void adopt(std::span<const TouchContact> contacts) override;
  void settle(std::span<const MovingTool> tools) override;
  void state(State& s, std::span<const MovingTool> tools) override;
  void load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const override;
  bool superposed() const override { return true; }
  std::vector<BodyNews> news() const override;
  void tell(BodyMessage& message) override;

 protected:
  bool by_mesh() const override { return by_mesh_; }
  Eigen::Vector3d press_of(int tool) const override;

 private:
  /// `creep`: what it does within a step; empty where it does not relax.
  QuasiStaticBody(const Archive& archive, const QuasiStaticSpec& body, const StepSettings& settings,
                  const std::optional<CreepStep>& creep);

  ToolContacts::Options beside_patches();
  bool by_patch(const TouchContact& contact) const;
  bool is_held(int node) const;
  void superpose(int tool, std::vector<double>& displacement);
  void correct(std::span<const MovingTool> tools);
  QuasiNonlinear correction_of(int tool) const;
  void recall(Moment moment, std::span<const int> nodes, std::span<double> displacement);
  void recall_ahead(std::span<const int> nodes, std::span<double> displacement);
  void lay_ground();
  void remember();

  int settling_ = 0;  ///< steps in which what it has taken up relaxes
  std::optional<BodyNonlinear> nonlinear_;
  std::unique_ptr<ForceMemory> memory_;  ///< null: it does not relax
  std::unique_ptr<PatchTouch> patch_;    ///< null: all parts touch by the mesh
  bool by_mesh_ = true;                  ///< set by the constructor
  std::optional<LoadSum<double>> sum_;   ///< set by the constructor, behind the compliance
  std::vector<double> displacement_, of_tool_;
  std::vector<int> held_;               ///< places among the marked nodes
  std::vector<int> under_, touchable_;  ///< nodes that contacts hold, or patches lie on
  std::vector<double> past_under_;      ///< [m] what the past has left of the contacts' displacement
};

}  // namespace palpate
