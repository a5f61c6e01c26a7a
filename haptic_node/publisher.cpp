#include "haptic_node/publisher.hpp"

#include <algorithm>

namespace palpate {

void describe(const Task& task, TaskRecord& record) {
  record.inserted = task.inserted;
  record.deepest = task.deepest;
  record.inserting_s = task.inserting_s();
  record.largest_force = task.largest_force;
  record.wall_contacts = task.wall_contacts;
  record.grasps = task.grasps;
  record.drops = task.drops;
  record.held_s = task.held_s;
}

Publisher::Publisher(Bus& bus, const HapticStep& haptic, std::uint64_t run)
    : tool_(bus.writer(topics::tool_state)),
      contact_(bus.writer(topics::contact_state)),
      force_(bus.writer(topics::force_state)),
      keyframe_(bus.writer(topics::haptic_keyframe)),
      run_(run),
      of_tool_(haptic.tools()) {
  if (!haptic.modal_bodies().empty()) modal_ = bus.writer(topics::modal_state);
  for (const ReducedBody& b : haptic.modal_bodies()) {
    modal_states_.push_back({.body = static_cast<std::uint32_t>(b.body), .run = run});
    modal_states_.back().coordinates.resize(b.size);
  }
  if (haptic.catheters().empty()) return;
  catheter_ = bus.writer(topics::catheter_state);
  task_ = bus.writer(topics::task_record);
  for (const ReducedBody& b : haptic.catheters()) {
    catheter_states_.push_back({.body = static_cast<std::uint32_t>(b.body), .run = run});
    catheter_states_.back().position.resize(3 * b.size);
    task_records_.push_back({.body = static_cast<std::uint32_t>(b.body), .run = run});
  }
}

void Publisher::publish(const StepRecord& r) {
  for (int t = 0; t < r.tools; ++t) {
    const StepRecord::OfTool& from = r.of_tool[t];
    OfTool& state = of_tool_[t];
    const auto tool = static_cast<std::uint32_t>(t);
    publish_contacts(r, t);  // first: the picture waits for it
    force_->write({.tool = tool,
                   .run = run_,
                   .seq = ++state.force_seq,
                   .step = r.step,
                   .sense_ns = r.sense_ns,
                   .force = from.force,
                   .torque = from.torque,
                   .grip = from.grip_torque,
                   .trocar = from.trocar,
                   .energy = r.energy,
                   .flags = from.flags});
    tool_->write({.tool = tool,
                  .run = run_,
                  .seq = ++state.tool_seq,
                  .step = r.step,
                  .sense_ns = r.sense_ns,
                  .device_seq = from.device_seq,
                  .yaw = from.dofs.yaw,
                  .pitch = from.dofs.pitch,
                  .depth = from.dofs.depth,
                  .roll = from.dofs.roll,
                  .grip = from.dofs.grip,
                  .opening = from.opening,
                  .pedal = from.dofs.pedal,
                  .local_model_run = from.model_run,
                  .local_model_seq = from.model_seq});
  }
  if (r.has_shapes) publish_shapes(r);
  if (!task_) return;
  take_tasks(r);
  if (r.step % task_interval == 0) finish();
}

void Publisher::publish_shapes(const StepRecord& r) {
  const double* from = r.coordinates.data();
  for (ModalState& m : modal_states_) {
    ++m.seq;
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
    modal_->write(m);
  }
  from = r.particles.data();
  for (CatheterState& m : catheter_states_) {
    ++m.seq;
    m.step = r.step;
    m.sense_ns = r.sense_ns;
    std::copy_n(from, m.position.size(), m.position.begin());
    from += m.position.size();
    catheter_->write(m);
  }
}

void Publisher::take_tasks(const StepRecord& r) {
  for (std::size_t i = 0; i < task_records_.size(); ++i) {
    task_records_[i].step = r.step;
    task_records_[i].sense_ns = r.sense_ns;
    describe(r.tasks[i], task_records_[i]);
  }
}

void Publisher::finish() {
  for (TaskRecord& m : task_records_) {
    ++m.seq;
    task_->write(m);
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
