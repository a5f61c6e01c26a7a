#include "common/sim/step_record.hpp"

#include <algorithm>

namespace palpate {
namespace {

std::array<double, 3> plain(const Eigen::Vector3d& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

void prepare_record(const HapticStep& haptic, StepRecord& r) {
  r.news = haptic.news();
  BodyPart::Capacity all;
  for (const HapticStep::Entry& entry : haptic.entries()) {
    all.contacts += entry.part->capacity().contacts;
    all.forces += entry.part->capacity().forces;
  }
  r.contacts.reserve(all.contacts);
  r.forces.reserve(all.forces);
}

namespace {

void fill_news(const HapticStep& haptic, StepRecord& r) {
  for (BodyNews& news : r.news) {
    if (!news.due(r.step) && !news.to_the_end) continue;
    std::visit([&](auto& m) { m.step = r.step, m.sense_ns = r.sense_ns; }, news.message);
    haptic.tell(news.message);
  }
}

void add_contact(const TouchContact& c, std::uint32_t body, StepRecord& r) {
  HeldContact to{};
  to.body = body;
  for (int v = 0; v < 3; ++v) to.nodes[v] = static_cast<std::uint32_t>(c.anchor.nodes[v]);
  to.weights = plain(c.anchor.weights);
  to.offset = plain(c.tool_point().offset);
  to.normal = plain(c.normal);
  to.force = plain(c.force);
  to.sample = static_cast<std::uint32_t>(c.tool_point().part);
  to.sticking = c.grasped ? kInJaws : c.touch == Touch::sticking;
  r.contacts.push_back({c.tool_point().tool, to});
}

}  // namespace

void fill_record(const HapticStep& haptic, std::span<const DeviceSample> samples, std::uint64_t step,
                 std::int64_t sense_ns, StepRecord& r) {
  r.step = step;
  r.sense_ns = sense_ns;
  r.energy = haptic.energy();
  r.tools = haptic.tools();
  r.contacts.clear();
  r.forces.clear();
  for (int t = 0; t < r.tools; ++t) {
    const bool moving = haptic.has_moving_tissue();
    const Eigen::Vector4d& along = haptic.force_along_dofs(t);
    r.of_tool[t] = {.dofs = samples[t].dofs,
                    .opening = haptic.opening(t),
                    .holding = haptic.rig(t).end().holding(),
                    .device_seq = samples[t].seq,
                    .force = plain(haptic.force(t)),
                    .torque = plain(haptic.torque(t)),
                    .press = plain(haptic.press(t)),
                    .trocar = plain(haptic.trocar_force(t)),
                    .along = {along[0], along[1], along[2], along[3]},
                    .grip_torque = haptic.grip_torque(t),
                    .flags = haptic.flags(t),
                    .model_run = moving ? haptic.local(t).model().run : 0,
                    .model_seq = moving ? haptic.local(t).model().seq : 0};
  }
  for (const HapticStep::Entry& entry : haptic.entries()) {
    const auto body = static_cast<std::uint32_t>(entry.body);
    entry.part->for_each_contact([&r, body](const TouchContact& c) { add_contact(c, body, r); });
    if (!entry.part->superposed()) continue;  // its shape follows from its own state
    entry.part->for_each_force([&r, body](int tool, int node, const Eigen::Vector3d& f) {
      r.forces.push_back({tool, {body, static_cast<std::uint32_t>(node), plain(f)}});
    });
  }
  fill_news(haptic, r);
}

}  // namespace palpate
