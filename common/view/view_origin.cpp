#include "common/view/view_origin.hpp"

#include "common/mesh/near_origin.hpp"

namespace palpate {

Eigen::Vector3d view_origin(std::span<const Archive> bodies) {
  return bodies.empty() ? Eigen::Vector3d::Zero().eval() : near_origin(bodies.front().surface.position);
}

std::vector<Eigen::Vector3f> places_from(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3d> places) {
  std::vector<Eigen::Vector3f> from;
  from.reserve(places.size());
  for (const Eigen::Vector3d& p : places) from.emplace_back((p - origin).cast<float>());
  return from;
}

}  // namespace palpate
