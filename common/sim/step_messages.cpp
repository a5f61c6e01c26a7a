#include "common/sim/step_messages.hpp"

#include <algorithm>

namespace palpate {

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
          .silent = from.dofs.silent,
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
          .yaw_torque = from.along[0],
          .pitch_torque = from.along[1],
          .depth_force = from.along[2],
          .roll_torque = from.along[3],
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
  for (const auto& [by, contact] : r.contacts)
    if (by == tool) m.contacts.push_back(contact);
  for (const auto& [by, force] : r.forces)
    if (by == tool) m.forces.push_back(force);
}

std::vector<TaskRecord> task_records(const HapticStep& haptic) {
  std::vector<TaskRecord> records;
  for (BodyNews& news : haptic.news()) {
    auto* record = std::get_if<TaskRecord>(&news.message);
    if (!record) continue;
    haptic.tell(news.message);
    records.push_back(*record);
  }
  return records;
}

}  // namespace palpate
