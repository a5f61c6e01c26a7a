#include "common/sim/step_messages.hpp"

#include <algorithm>

namespace palpate {

void describe(const Task& task, TaskRecord& record) {
  record.inserted = task.inserted;
  record.deepest = task.deepest;
  record.inserting_s = task.inserting_s();
  record.max_force = task.max_force;
  record.wall_contacts = task.wall_contacts;
  record.grasps = task.grasps;
  record.drops = task.drops;
  record.held_s = task.held_s;
}

ToolState tool_state(const StepRecord& r, int tool) {
  const StepRecord::OfTool& from = r.of_tool[tool];
  return {.tool = static_cast<std::uint32_t>(tool),
          .step = r.step,
          .sense_ns = r.sense_ns,
          .device_seq = from.device_seq,
          .yaw = from.dofs.yaw,
          .pitch = from.dofs.pitch,
          .depth = from.dofs.depth,
          .roll = from.dofs.roll,
          .grip = from.dofs.grip,
          .opening = from.opening,
          .holding = from.holding,
          .pedal = from.dofs.pedal,
          .local_model_run = from.model_run,
          .local_model_seq = from.model_seq};
}

ForceState force_state(const StepRecord& r, int tool) {
  const StepRecord::OfTool& from = r.of_tool[tool];
  return {.tool = static_cast<std::uint32_t>(tool),
          .step = r.step,
          .sense_ns = r.sense_ns,
          .force = from.force,
          .torque = from.torque,
          .grip = from.grip_torque,
          .trocar = from.trocar,
          .energy = r.energy,
          .flags = from.flags};
}

void describe_contacts(const StepRecord& r, int tool, ContactState& m) {
  m.tool = static_cast<std::uint32_t>(tool);
  m.step = r.step;
  m.sense_ns = r.sense_ns;
  m.press = r.of_tool[tool].press;
  m.forces.clear();
  m.contacts.clear();
  for (int i = 0; i < r.contacts; ++i)
    if (r.contact_tool[i] == tool) m.contacts.push_back(r.contact[i]);
  for (int i = 0; i < r.forces; ++i)
    if (r.nodal_tool[i] == tool) m.forces.push_back(r.nodal[i]);
}

std::vector<ModalState> modal_states(const HapticStep& haptic, std::uint64_t run) {
  std::vector<ModalState> messages;
  for (const auto& m : haptic.modal_bodies()) {
    messages.push_back({.body = static_cast<std::uint32_t>(m.body), .run = run});
    messages.back().coordinates.resize(m.part->coordinates().size());
  }
  return messages;
}

std::vector<CatheterState> catheter_states(const HapticStep& haptic, std::uint64_t run) {
  std::vector<CatheterState> messages;
  for (const auto& c : haptic.catheters()) {
    messages.push_back({.body = static_cast<std::uint32_t>(c.body), .run = run});
    messages.back().position.resize(3 * c.part->body().positions().size());
  }
  return messages;
}

void describe_shapes(const StepRecord& r, std::vector<ModalState>& messages) {
  const double* from = r.coordinates.data();
  for (ModalState& m : messages) {
    m.step = r.step;
    m.sense_ns = r.sense_ns;
    std::copy_n(from, m.coordinates.size(), m.coordinates.begin());
    from += m.coordinates.size();
    m.forces.clear();
    for (const StepRecord::OnShell& f : r.on_shell) {
      if (f.body != m.body) continue;
      const auto same = std::ranges::find(m.forces, f.force.node, &ShellForce::node);
      if (same == m.forces.end())
        m.forces.push_back(f.force);
      else
        for (int axis = 0; axis < 3; ++axis) same->force[axis] += f.force.force[axis];
    }
  }
}

void describe_shapes(const StepRecord& r, std::vector<CatheterState>& messages) {
  const double* from = r.particles.data();
  for (CatheterState& m : messages) {
    m.step = r.step;
    m.sense_ns = r.sense_ns;
    std::copy_n(from, m.position.size(), m.position.begin());
    from += m.position.size();
  }
}

}  // namespace palpate
