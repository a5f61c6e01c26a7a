#include "haptic_node/publisher.hpp"

#include "common/sim/step_messages.hpp"

namespace palpate {

Publisher::Publisher(Bus& bus, const HapticStep& haptic, std::uint64_t run)
    : tool_(bus.writer(topics::tool_state)),
      contact_(bus.writer(topics::contact_state)),
      force_(bus.writer(topics::force_state)),
      keyframe_(bus.writer(topics::haptic_keyframe)),
      run_(run),
      of_tool_(haptic.tools()) {
  if (!haptic.modal_bodies().empty()) modal_ = bus.writer(topics::modal_state);
  modal_states_ = modal_states(haptic, run);
  if (haptic.catheters().empty()) return;
  catheter_ = bus.writer(topics::catheter_state);
  task_ = bus.writer(topics::task_record);
  catheter_states_ = catheter_states(haptic, run);
  for (const auto& c : haptic.catheters())
    task_records_.push_back({.body = static_cast<std::uint32_t>(c.body), .run = run});
}

void Publisher::publish(const StepRecord& r) {
  for (int t = 0; t < r.tools; ++t) {
    OfTool& state = of_tool_[t];
    publish_contacts(r, t);  // first: the picture waits for it
    ForceState force = force_state(r, t);
    force.run = run_;
    force.seq = ++state.force_seq;
    force_->write(force);
    ToolState tool = tool_state(r, t);
    tool.run = run_;
    tool.seq = ++state.tool_seq;
    tool_->write(tool);
  }
  if (r.has_shapes) publish_shapes(r);
  if (!task_) return;
  take_tasks(r);
  if (r.step % kTaskInterval == 0) finish();
}

void Publisher::publish_shapes(const StepRecord& r) {
  describe_shapes(r, modal_states_);
  describe_shapes(r, catheter_states_);
  for (ModalState& m : modal_states_) {
    ++m.seq;
    modal_->write(m);
  }
  for (CatheterState& m : catheter_states_) {
    ++m.seq;
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
  describe_contacts(r, t, m);
  const bool touching = !m.contacts.empty();
  const bool quiet = !touching && !state.touching;
  state.touching = touching;
  if (quiet && ++state.quiet < kQuietInterval) return;
  state.quiet = 0;
  m.run = run_;
  m.seq = ++state.contact_seq;
  contact_->write(m);
}

void Publisher::publish(const HapticKeyframe& keyframe) {
  HapticKeyframe numbered = keyframe;
  numbered.run = run_;
  numbered.seq = ++keyframe_seq_;
  keyframe_->write(numbered);
}

}  // namespace palpate
