#include "haptic_node/publisher.hpp"

namespace palpate {

Publisher::Publisher(Bus& bus, int tools, std::uint64_t run)
    : tool_(bus.writer(topics::tool_state)),
      contact_(bus.writer(topics::contact_state)),
      force_(bus.writer(topics::force_state)),
      keyframe_(bus.writer(topics::haptic_keyframe)),
      run_(run),
      of_tool_(tools) {}

void Publisher::publish(const StepRecord& r) {
  for (int t = 0; t < r.tools; ++t) {
    const StepRecord::OfTool& from = r.of_tool[t];
    OfTool& state = of_tool_[t];
    const auto tool = static_cast<std::uint32_t>(t);
    publish_contacts(r, t);  // first: the picture waits for it
    force_->write({.tool = tool, .run = run_, .seq = ++state.force_seq, .step = r.step, .sense_ns = r.sense_ns, .force = from.force,
                   .torque = from.torque, .flags = from.flags});
    tool_->write({.tool = tool, .run = run_, .seq = ++state.tool_seq, .step = r.step, .sense_ns = r.sense_ns, .device_seq = from.device_seq,
                  .yaw = from.dofs.yaw, .pitch = from.dofs.pitch, .depth = from.dofs.depth, .roll = from.dofs.roll, .grip = from.dofs.grip,
                  .pedal = from.dofs.pedal, .local_model_run = from.model_run, .local_model_seq = from.model_seq});
  }
}

void Publisher::publish_contacts(const StepRecord& r, int t) {
  OfTool& state = of_tool_[t];
  ContactState& m = state.contacts;
  m.forces.clear();
  m.contacts.clear();
  for (int i = 0; i < r.contacts; ++i)
    if (r.contact_tool[i] == t) m.contacts.push_back(r.contact[i]);
  for (int i = 0; i < r.forces; ++i)
    if (r.nodal_tool[i] == t) m.forces.push_back(r.nodal[i]);
  const bool touching = !m.contacts.empty();
  const bool quiet = !touching && !state.touching;
  state.touching = touching;
  if (quiet && ++state.quiet < quiet_interval) return;
  state.quiet = 0;
  m.tool = static_cast<std::uint32_t>(t);
  m.run = run_;
  m.seq = ++state.contact_seq;
  m.step = r.step;
  m.sense_ns = r.sense_ns;
  m.press = r.of_tool[t].press;
  contact_->write(m);
}

void Publisher::publish(const HapticKeyframe& keyframe) {
  HapticKeyframe numbered = keyframe;
  numbered.run = run_;
  numbered.seq = ++keyframe_seq_;
  keyframe_->write(numbered);
}

}  // namespace palpate
