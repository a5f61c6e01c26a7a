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
  unsigned char face, grasped, touch;
  double weights[3], offset[3], normal[3], slip[3], force[3], point_force[9];
  int points;
};

void put(double* to, const Eigen::Vector3d& v) {
  std::memcpy(to, v.data(), sizeof(double[3]));
}
Eigen::Vector3d get(const double* from) {
  return {from[0], from[1], from[2]};
}

}  // namespace

std::size_t ToolContacts::state_size() const {
  return surface_.state_size() + sizeof(int) + law_.capacity() * sizeof(StoredContact);
}

void ToolContacts::save(unsigned char* to) const {
  surface_.save(to);
  to += surface_.state_size();
  const int count = static_cast<int>(law_.contacts().size());
  std::memcpy(to, &count, sizeof count);
  to += sizeof count;
  std::memset(to, 0, law_.capacity() * sizeof(StoredContact));
  for (int i = 0; i < count; ++i) {
    const TouchContact& c = law_.contacts()[i];
    const std::span<const double> forces = law_.point_forces(i);
    StoredContact s{};
    s.tool = c.tool;
    s.part = c.part;
    std::copy(c.anchor.nodes.begin(), c.anchor.nodes.end(), s.nodes);
    s.face = c.face;
    s.grasped = c.grasped;
    s.touch = static_cast<unsigned char>(c.touch);
    put(s.weights, c.anchor.weights);
    put(s.offset, c.offset);
    put(s.normal, c.normal);
    put(s.slip, c.slip);
    put(s.force, c.force);
    std::copy(forces.begin(), forces.end(), s.point_force);
    s.points = static_cast<int>(forces.size()) / 3;
    std::memcpy(to, &s, sizeof s);
    to += sizeof s;
  }
}

void ToolContacts::restore(const unsigned char* from, std::span<const MovingTool> tools) {
  surface_.restore(from);
  from += surface_.state_size();
  int count = 0;
  std::memcpy(&count, from, sizeof count);
  from += sizeof count;
  if (count < 0 || count > law_.capacity())
    throw std::runtime_error("the state names an impossible number of contacts");
  law_.clear();
  for (int i = 0; i < count; ++i, from += sizeof(StoredContact)) {
    StoredContact s;
    std::memcpy(&s, from, sizeof s);
    const bool tool_known = s.tool >= 0 && s.tool < static_cast<int>(tools.size());
    if (!tool_known || s.part < 0 || s.part >= tools[s.tool].size() || s.touch > 2 || (s.points != 1 && s.points != 3))
      throw std::runtime_error("the state holds a contact that this scene cannot have");
    for (int node : s.nodes)
      if (node < 0 || node >= nodes_) throw std::runtime_error("the state names a surface node that the body lacks");
    TouchContact c{.tool = s.tool,
                   .part = s.part,
                   .face = s.face != 0,
                   .grasped = s.grasped != 0,
                   .touch = static_cast<Touch>(s.touch)};
    c.anchor = {{s.nodes[0], s.nodes[1], s.nodes[2]}, get(s.weights)};
    c.offset = get(s.offset);
    c.normal = get(s.normal);
    c.slip = get(s.slip);
    c.force = get(s.force);
    c.softness = softness(c.tool);
    law_.add(c, std::span(s.point_force).first(3 * s.points));
  }
}

}  // namespace palpate
