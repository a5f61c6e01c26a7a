// What ToolContacts remembers from step to step, from which a replay starts.
#include <algorithm>

#include "common/contact/tool_contacts.hpp"

namespace palpate {
namespace {

/// A contact by a tool, and the forces [N] of the points that stand for it: one, or three under the alpha rule.
struct KeptContact {
  TouchContact contact;
  std::array<double, 9> forces{};
  int points = 1;
};

void walk(State& s, KeptContact& kept) {
  TouchContact& c = kept.contact;
  palpate::state(s, c.tool_point());
  palpate::state(s, c.anchor);
  for (bool* flag : {&c.face, &c.grasped}) s.value(*flag);
  s.value(c.touch);
  for (Eigen::Vector3d* v : {&c.normal, &c.slip, &c.force}) s.value(*v);
  s.value(kept.forces);
  s.value(kept.points);
}

std::size_t size_of_one() {
  KeptContact any;
  State s = State::measure();
  walk(s, any);
  return s.size();
}

/// Of a contact that was read: whether a scene with these tools and so many surface nodes can have it.
bool can_be(const KeptContact& kept, std::span<const MovingTool> tools, int nodes) {
  const ToolPoint& by = kept.contact.tool_point();
  const bool tool_known = by.tool >= 0 && by.tool < static_cast<int>(tools.size());
  if (!tool_known || by.part < 0 || by.part >= tools[by.tool].size()) return false;
  if (kept.contact.touch > Touch::sticking || (kept.points != 1 && kept.points != 3)) return false;
  return std::ranges::all_of(kept.contact.anchor.nodes, [&](int node) { return node >= 0 && node < nodes; });
}

}  // namespace

void ToolContacts::state(State& s, std::span<const MovingTool> tools) {
  int count = static_cast<int>(law_.contacts().size());
  s.value(count);
  s.require(count >= 0 && count <= law_.capacity(), "the state names an impossible number of contacts");
  if (s.restoring()) law_.clear();
  for (int i = 0; i < count; ++i) {
    KeptContact kept;
    if (!s.restoring()) {
      kept.contact = law_.contacts()[i];
      kept.points = static_cast<int>(law_.point_forces(i).size()) / 3;
      std::ranges::copy(law_.point_forces(i), kept.forces.begin());
    }
    walk(s, kept);
    if (!s.restoring()) continue;
    s.require(can_be(kept, tools, surface_.nodes()), "the state holds a contact that this scene cannot have");
    ToolPoint& by = kept.contact.tool_point();
    const bool point = kept.contact.face && !kept.contact.grasped;
    by.softness = point ? face_softness(by.tool, radius(tools[by.tool], by.part)) : softness(by.tool);
    law_.add(kept.contact, std::span(kept.forces).first(3 * kept.points));
  }
  s.skip(static_cast<std::size_t>(law_.capacity() - count) * size_of_one());
}

}  // namespace palpate
