#include "common/models/quasi_static/relaxing_shape.hpp"

#include <algorithm>

namespace palpate {

bool RelaxingShape::is_mine(const CreepState& state) const {
  const auto nodes = static_cast<std::uint32_t>(map().size());
  return std::ranges::all_of(state.loads, [=](const CreepLoad& l) { return l.node < nodes; });
}

void RelaxingShape::displace(const ContactsOnBody& contacts, std::vector<Eigen::Vector3f>& displacement) {
  sum_.clear();
  for (const auto& [tool, state] : contacts.of_tool) sum_.add(state, contacts.body);
  if (newest())
    for (const CreepLoad& l : newest()->loads) sum_.add(l.node, Eigen::Vector3f(l.load.data()));
  sum_.combine(displacement);
}

}  // namespace palpate
