#include "common/models/body_shape.hpp"

#include <algorithm>

#include "common/mesh/normals.hpp"

namespace palpate {

void BodyShape::rebuild(const ContactsOnBody& contacts, DeformedSurface& surface) {
  displace(contacts, surface.displacement);
  for (std::size_t n = 0; n < surface.position.size(); ++n)
    surface.position[n] = (map_.position[n] - origin_).cast<float>() + surface.displacement[n];
  vertex_normals(surface.position, map_.triangles, surface.normal);
}

void BodyShape::displace(const ContactsOnBody&, std::vector<Eigen::Vector3f>& displacement) {
  std::ranges::fill(displacement, Eigen::Vector3f::Zero());
}

}  // namespace palpate
