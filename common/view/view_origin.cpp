#include "common/view/view_origin.hpp"

#include "common/mesh/near_origin.hpp"

namespace palpate {

Eigen::Vector3d view_origin(std::span<const Archive> bodies) {
  return bodies.empty() ? Eigen::Vector3d::Zero().eval() : near_origin(bodies.front().surface.position);
}

}  // namespace palpate
