// Forceps, catheters and the task in a haptic step.
#include <algorithm>

#include "common/sim/haptic_step.hpp"

namespace palpate {
namespace {

// A probe meets a catheter with its tip and its shaft; a forceps with its three segments.
int parts_against_catheters(const MovingTool& tool, bool forceps) {
  return forceps ? tool.size() : 2;
}

CatheterTool part_of(const MovingTool& tool, int part, bool forceps) {
  CatheterTool out{.part = part};
  Segment before = tool.axis_before(part), now = tool.axis(part);
  if (!forceps && part == 1) {
    before.end = tool.axis_before(tool.size() - 1).start;
    now.end = tool.axis(tool.size() - 1).start;
  }
  out.before = {before.start, before.end};
  out.now = {now.start, now.end};
  out.radius = tool.radius(part);
  return out;
}

}  // namespace

void HapticStep::build_catheters(const Scene& scene) {
  int parts = 0;
  for (int t = 0; t < tools(); ++t) parts += parts_against_catheters(moving_[t], hands_[t].has_value());
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    catheters_.emplace_back();
    ducts_.push_back(nullptr);
    const auto* spec = as<CatheterSpec>(body);
    if (!spec) continue;
    const auto duct =
        std::ranges::find_if(scene.bodies, [&](const Body& other) { return name_of(other) == spec->catheter.inside; });
    if (duct != scene.bodies.end()) ducts_.back() = modal_[duct - scene.bodies.begin()];
    const CatheterSettings settings{.shape = spec->catheter,
                                    .young = spec->material.young,
                                    .density = spec->material.density,
                                    .step = dt_,
                                    .friction = scene.contact.friction,
                                    .most_parts = std::max(parts, 1),
                                    .most_tools = std::max(tools(), 1)};
    catheters_.back() = std::make_unique<CatheterBody>(settings, ducts_.back());
    catheter_bodies_.push_back({static_cast<int>(b), static_cast<std::size_t>(catheters_.back()->size())});
  }
  tasks_.resize(catheter_bodies_.size());
  wall_contacts_.assign(catheter_bodies_.size(), 0);
  held_before_.assign(catheter_bodies_.size(), 0);
  if (tasks_.empty()) return;
  for (int t = 0; t < tools(); ++t)
    for (int p = 0; p < parts_against_catheters(moving_[t], hands_[t].has_value()); ++p)
      catheter_tools_.push_back(
          {.tool = t, .part = p, .compliance = tool_compliance_[t], .friction = scene.contact.friction});
  jaw_poses_.resize(moving_.size(), Eigen::Isometry3d::Identity());
}

// Jaws follow their handles until they touch what is between them, as bodies and tools stand at the step's begin.
void HapticStep::work_forceps(std::span<const ToolDofs> dofs) {
  for (int t = 0; t < tools(); ++t) {
    if (!hands_[t]) continue;
    std::ranges::copy(parts_[t], parts_before_[t].begin());
    for (std::size_t i = 0; i < tasks_.size(); ++i) held_before_[i] = catheters_[catheter_bodies_[i].body]->holds(t);
    const GripEvent event = hands_[t]->work(dofs[t].grip, moving_[t].before, {bodies_, catheters_});
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      tasks_[i].grasps += event == GripEvent::taken && catheters_[catheter_bodies_[i].body]->holds(t);
      tasks_[i].drops += event == GripEvent::dropped && held_before_[i];
    }
    set_opening(hands_[t]->opening(), parts_[t]);
  }
}

// Catheters move against the walls and the tools; what they do to either is kept for both. False if one is lost.
bool HapticStep::move_catheters() {
  if (tasks_.empty()) return true;
  for (CatheterTool& tool : catheter_tools_) {
    const CatheterTool now = part_of(moving_[tool.tool], tool.part, hands_[tool.tool].has_value());
    tool.before = now.before;
    tool.now = now.now;
    tool.radius = now.radius;
  }
  for (int t = 0; t < tools(); ++t) jaw_poses_[t] = moving_[t].now;
  bool finite = true;
  for (const ReducedBody& c : catheter_bodies_) {
    CatheterBody& catheter = *catheters_[c.body];
    catheter.step(catheter_tools_, jaw_poses_);
    if (ducts_[c.body]) ducts_[c.body]->push(catheter.wall_forces());
    for (const CatheterToolForce& f : catheter.tool_forces()) {
      output_[f.tool].force -= f.force;
      output_[f.tool].torque -= (f.point - moving_[f.tool].now.translation()).cross(f.force);
    }
    for (const Eigen::Vector3d& x : catheter.positions()) finite &= x.allFinite();
  }
  return finite;
}

void HapticStep::keep_tasks() {
  const double time = static_cast<double>(step_ + 1) * dt_;
  for (std::size_t i = 0; i < tasks_.size(); ++i) {
    const CatheterBody& catheter = *catheters_[catheter_bodies_[i].body];
    Task& task = tasks_[i];
    task.enter_depth(catheter.inserted(), time);
    const int touching = catheter.wall_contacts();
    task.wall_contacts += static_cast<std::uint64_t>(std::max(0, touching - wall_contacts_[i]));
    wall_contacts_[i] = touching;
    bool held = false;
    for (int t = 0; t < tools(); ++t) {
      task.largest_force = std::max(task.largest_force, output_[t].force.norm());
      held |= catheter.holds(t);
    }
    if (held) task.held_s += dt_;
  }
}

}  // namespace palpate
