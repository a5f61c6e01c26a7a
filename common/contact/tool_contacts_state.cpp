// The state of ToolContacts as bytes, from which a replay starts.
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "common/contact/tool_contacts.hpp"

namespace palpate {
namespace {

// A contact as plain bytes for the state that replay starts from.
struct StoredContact {
  int tool, part, nodes[3];
  unsigned char face, grasped, touch, leaving;
  double receded, receding, weights[3], offset[3], normal[3], slip[3], force[3], point_force[9];
  int points;
};

void put(double* to, const Eigen::Vector3d& v) {
  std::memcpy(to, v.data(), sizeof(double[3]));
}
Eigen::Vector3d get(const double* from) {
  return {from[0], from[1], from[2]};
}

StoredContact stored(const TouchContact& c, std::span<const double> forces) {
  StoredContact s{};
  s.tool = c.tool_point().tool;
  s.part = c.tool_point().part;
  std::copy(c.anchor.nodes.begin(), c.anchor.nodes.end(), s.nodes);
  s.face = c.face;
  s.grasped = c.grasped;
  s.touch = static_cast<unsigned char>(c.touch);
  s.leaving = c.leaving;
  s.receded = c.receded;
  s.receding = c.receding;
  put(s.weights, c.anchor.weights);
  put(s.offset, c.tool_point().offset);
  put(s.normal, c.normal);
  put(s.slip, c.slip);
  put(s.force, c.force);
  std::copy(forces.begin(), forces.end(), s.point_force);
  s.points = static_cast<int>(forces.size()) / 3;
  return s;
}

TouchContact contact_of(const StoredContact& s) {
  TouchContact c{.by = ToolPoint{.tool = s.tool, .part = s.part, .offset = get(s.offset)},
                 .face = s.face != 0,
                 .grasped = s.grasped != 0,
                 .touch = static_cast<Touch>(s.touch),
                 .leaving = s.leaving != 0,
                 .receded = s.receded,
                 .receding = s.receding};
  c.anchor = {{s.nodes[0], s.nodes[1], s.nodes[2]}, get(s.weights)};
  c.normal = get(s.normal);
  c.slip = get(s.slip);
  c.force = get(s.force);
  return c;
}

// Of a contact that was read: whether a scene with these tools and so many surface nodes can have it.
bool can_be(const StoredContact& s, std::span<const MovingTool> tools, int nodes) {
  const bool tool_known = s.tool >= 0 && s.tool < static_cast<int>(tools.size());
  if (!tool_known || s.part < 0 || s.part >= tools[s.tool].size() || s.touch > 2) return false;
  if (s.points != 1 && s.points != 3) return false;
  return std::ranges::all_of(s.nodes, [&](int node) { return node >= 0 && node < nodes; });
}

}  // namespace

void ToolContacts::state(State& s, std::span<const MovingTool> tools) {
  int count = static_cast<int>(law_.contacts().size());
  s.value(count);
  s.require(count >= 0 && count <= law_.capacity(), "the state names an impossible number of contacts");
  if (s.restoring()) law_.clear();
  for (int i = 0; i < count; ++i) {
    StoredContact c = s.restoring() ? StoredContact{} : stored(law_.contacts()[i], law_.point_forces(i));
    s.value(c);
    if (!s.restoring()) continue;
    s.require(can_be(c, tools, surface_.nodes()), "the state holds a contact that this scene cannot have");
    TouchContact contact = contact_of(c);
    contact.tool_point().softness = softness(contact.tool_point().tool);
    law_.add(contact, std::span(c.point_force).first(3 * c.points));
  }
  s.skip((static_cast<std::size_t>(law_.capacity()) - static_cast<std::size_t>(count)) * sizeof(StoredContact));
}

}  // namespace palpate
