#include "haptic_node/step_record.hpp"

namespace palpate {
namespace {

std::array<double, 3> plain(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace

void fill_record(const HapticStep& haptic, std::span<const DeviceSample> samples, std::uint64_t step, std::int64_t sense_ns,
                 StepRecord& r) {
  r.step = step;
  r.sense_ns = sense_ns;
  r.tools = haptic.tools();
  r.contacts = r.forces = 0;
  for (int t = 0; t < r.tools; ++t) {
    const bool moving = haptic.has_moving_tissue();
    r.of_tool[t] = {.dofs = samples[t].dofs,
                    .device_seq = samples[t].seq,
                    .force = plain(haptic.force(t)),
                    .torque = plain(haptic.torque(t)),
                    .press = plain(haptic.press(t)),
                    .flags = haptic.flags(t),
                    .model_run = moving ? haptic.local(t).model().run : 0,
                    .model_seq = moving ? haptic.local(t).model().seq : 0};
  }
  for (int b = 0; b < haptic.bodies(); ++b) {
    if (!haptic.is_touch_body(b)) continue;
    const ContactLaw& law = haptic.body(b).law();
    for (const TouchContact& c : law.contacts()) {
      if (c.touch == Touch::open || r.contacts == StepRecord::max_contacts) continue;
      HeldContact& to = r.contact[r.contacts];
      to.body = static_cast<std::uint32_t>(b);
      for (int v = 0; v < 3; ++v) to.nodes[v] = static_cast<std::uint32_t>(c.anchor.nodes[v]);
      to.weights = plain(c.anchor.weights);
      to.offset = plain(c.offset);
      to.normal = plain(c.normal);
      to.force = plain(c.force);
      to.sample = static_cast<std::uint32_t>(c.sample);
      to.sticking = c.touch == Touch::sticking;
      r.contact_tool[r.contacts++] = static_cast<std::uint8_t>(c.tool);
    }
    law.for_each_nodal_force([&](int contact, int node, const Eigen::Vector3d& f) {
      if (r.forces == StepRecord::max_forces) return;
      r.nodal[r.forces] = {static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(node), plain(f)};
      r.nodal_tool[r.forces++] = static_cast<std::uint8_t>(law.contacts()[contact].tool);
    });
  }
}

}  // namespace palpate
