#include "haptic_node/publisher.hpp"

#include "common/bus/topic_of.hpp"
#include "common/sim/step_messages.hpp"

namespace palpate {
namespace {

/// The contents of a record's message, under this publisher's numbers.
void take(const BodyMessage& from, BodyMessage& to) {
  std::visit(
      [&]<class M>(M& m) {
        const auto run = m.run, seq = m.seq;
        m = std::get<M>(from);
        m.run = run;
        m.seq = seq;
      },
      to);
}

}  // namespace

Publisher::Publisher(Bus& bus, const HapticStep& haptic, std::uint64_t run)
    : tool_(bus.writer(topics::tool_state)),
      contact_(bus.writer(topics::contact_state)),
      force_(bus.writer(topics::force_state)),
      keyframe_(bus.writer(topics::haptic_keyframe)),
      run_(run),
      of_tool_(haptic.tools()),
      news_(haptic.news()) {
  for (int t = 0; t < haptic.tools(); ++t) of_tool_[t].trocar = haptic.trocar(t);
  for (BodyNews& news : news_)
    std::visit(
        [&]<class M>(M& message) {
          message.run = run;
          auto& writer = std::get<std::unique_ptr<Writer<M>>>(writers_);
          if (!writer) writer = bus.writer(topic_of<M>());
        },
        news.message);
}

void Publisher::publish(const StepRecord& r) {
  for (int t = 0; t < r.tools; ++t) {
    OfTool& state = of_tool_[t];
    publish_contacts(r, t);  // first: the picture waits for it
    const StepRecord::OfTool& of = r.of_tool[t];
    state.handling.look(1e-9 * static_cast<double>(r.sense_ns), tip_pose(state.trocar, of.dofs).translation(),
                        Eigen::Map<const Eigen::Vector3d>(of.force.data()));
    ForceState force = force_state(r, t);
    force.run = run_;
    force.seq = ++state.force_seq;
    force_->gather(force);
    ToolState tool = tool_state(r, t);
    tool.run = run_;
    tool.seq = ++state.tool_seq;
    tool_->gather(tool);
  }
  contact_->send();
  force_->send();
  tool_->send();
  publish_news(r);
}

void Publisher::publish_news(const StepRecord& r) {
  for (std::size_t i = 0; i < news_.size(); ++i) {
    const bool due = r.news[i].due(r.step);
    if (!due && !news_[i].to_the_end) continue;
    take(r.news[i].message, news_[i].message);
    if (due) write(news_[i].message);
  }
}

void Publisher::write(BodyMessage& message) {
  std::visit(
      [&]<class M>(M& m) {
        ++m.seq;
        std::get<std::unique_ptr<Writer<M>>>(writers_)->write(m);
      },
      message);
}

void Publisher::finish() {
  for (BodyNews& news : news_)
    if (news.to_the_end) write(news.message);
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
  contact_->gather(m);
}

void Publisher::publish(const HapticKeyframe& keyframe) {
  HapticKeyframe numbered = keyframe;
  numbered.run = run_;
  numbered.seq = ++keyframe_seq_;
  keyframe_->write(numbered);
}

}  // namespace palpate
