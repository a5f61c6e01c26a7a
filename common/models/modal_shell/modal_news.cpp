// What a modal wall tells others: its modes' coordinates, and the forces that the modes left out answer to.
#include <algorithm>

#include "common/models/modal_shell/modal_body.hpp"

namespace palpate {

std::vector<BodyNews> ModalBody::news() const {
  ModalState state;
  state.coordinates.resize(x_.size());
  state.forces.reserve(std::min<std::size_t>(place_.size(), 3 * (kMaxContacts + kMaxWallForces)));
  std::vector<BodyNews> news(1);
  news[0].message = std::move(state);  // a copy would have no room
  return news;
}

// At most one force a node: what several contacts do to it is summed.
void ModalBody::tell(BodyMessage& message) {
  auto& state = std::get<ModalState>(message);
  state.forces.clear();
  show(state.coordinates.data(), [&](int node, const Eigen::Vector3d& f) {
    const Eigen::Vector3f force = f.cast<float>();
    if (place_[node] < 0) {
      place_[node] = static_cast<int>(state.forces.size());
      state.forces.push_back({static_cast<std::uint32_t>(node), {force[0], force[1], force[2]}});
      return;
    }
    for (int axis = 0; axis < 3; ++axis) state.forces[place_[node]].force[axis] += force[axis];
  });
  for (const ShellForce& f : state.forces) place_[f.node] = -1;
}

}  // namespace palpate
