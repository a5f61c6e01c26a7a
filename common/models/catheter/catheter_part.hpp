#pragma once
#include <memory>
#include <string>
#include <vector>

#include "common/contact/body_part.hpp"
#include "common/contact/step_settings.hpp"
#include "common/models/catheter/catheter_body.hpp"
#include "common/models/catheter/spec.hpp"
#include "common/models/catheter/task.hpp"

namespace palpate {

/// A catheter in the haptic step: it moves by itself against the wall of its duct and against the tools, forceps take
/// hold of it, and what the trainee does with it is measured.
class CatheterPart : public BodyPart {
 public:
  CatheterPart(const CatheterSpec& spec, const StepSettings& settings);

  const CatheterBody& body() const { return *body_; }
  const Task& task() const { return task_; }

  void join(const FindPart& find) override;
  std::span<const double> coordinates() const override;  ///< [m] x, y, z of each particle, from tail to tip
  std::vector<BodyNews> news() const override;
  void tell(BodyMessage& message) override;
  std::string introduction() const override;
  bool move(std::span<const MovingTool> tools, std::span<ToolLoad> loads) override;
  void finish(double max_force, double time) override;
  BetweenJaws between(const OpenJaws& jaws) override;
  void grasp(const OpenJaws& jaws) override;
  void let_go(int tool) override { body_->let_go(tool); }
  double grasp_load(int tool) const override { return body_->holds(tool) ? body_->load(tool) : 0; }
  void before_grip(int tool) override { held_before_ = body_->holds(tool); }
  void after_grip(int tool, GripEvent event) override;
  void state(State& s, std::span<const MovingTool> tools) override;

 private:
  CatheterSettings settings_;
  std::string inside_;
  double dt_;
  std::vector<CatheterTool> tools_;      ///< every part of every tool that may touch it
  std::vector<std::uint8_t> has_ball_;   ///< per tool
  std::vector<Eigen::Isometry3d> jaws_;  ///< per tool
  std::unique_ptr<CatheterBody> body_;
  DuctWall* duct_ = nullptr;  ///< what it is led into
  Task task_;
  int wall_contacts_ = 0;  ///< in the last step
  bool held_before_ = false;
};

}  // namespace palpate
