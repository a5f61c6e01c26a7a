#pragma once
#include <memory>
#include <optional>

#include "common/contact/patch/patch_touch.hpp"
#include "common/contact/touch_body.hpp"
#include "common/models/quasi_static/nonlinear.hpp"

namespace palpate {

/// A body without inertia: its shape follows from the contact forces by superposition of its tensors (TVCG99 sec. 4).
class QuasiStaticBody : public TouchBody {
 public:
  QuasiStaticBody(const Archive& archive, const QuasiStaticSpec& body, const StepSettings& settings);

  void update_surface(std::span<const MovingTool> tools) override;
  LawOutcome hold(std::span<const MovingTool> tools) override;
  void for_each_contact(const VisitContact& visit) const override;
  void for_each_force(const VisitForce& visit) const override;
  bool adopt(const TouchContact& contact) override;
  void state(State& s, std::span<const MovingTool> tools) override;
  void load(std::span<const MovingTool> tools, std::span<ToolLoad> loads) const override;
  bool superposed() const override { return true; }

 protected:
  Eigen::Vector3d press_of(int tool) const override;

 private:
  bool is_held(int node) const;
  void superpose(int tool, std::vector<double>& displacement);

  std::optional<QuasiNonlinear> nonlinear_;
  std::unique_ptr<PatchTouch> patch_;  ///< null: spheres touch as everything else does
  std::vector<const double*> columns_;
  std::vector<double> coefficients_, displacement_, of_tool_, whole_;
  std::vector<int> held_;  ///< places among the marked nodes
};

}  // namespace palpate
