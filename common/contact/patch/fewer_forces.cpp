#include "common/contact/patch/fewer_forces.hpp"

#include <algorithm>

namespace palpate {

void hand_to_fewer(std::size_t most, std::span<const Eigen::Vector3d> position, std::vector<PatchForce>& forces) {
  if (forces.size() <= most) return;
  const auto carries_more = [](const PatchForce& a, const PatchForce& b) {
    const double size_a = a.force.squaredNorm(), size_b = b.force.squaredNorm();
    return size_a != size_b ? size_a > size_b : a.node < b.node;
  };
  std::ranges::nth_element(forces, forces.begin() + static_cast<std::ptrdiff_t>(most), carries_more);
  const std::span<PatchForce> kept = std::span(forces).first(most);
  for (const PatchForce& from : std::span(forces).subspan(most)) {
    const auto far = [&](const PatchForce& to) { return (position[to.node] - position[from.node]).squaredNorm(); };
    std::ranges::min_element(kept, {}, far)->force += from.force;
  }
  forces.resize(most);
}

}  // namespace palpate
