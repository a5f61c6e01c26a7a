#include "common/models/quasi_static/column_sum.hpp"

#include <algorithm>

namespace palpate {

void ColumnSum::add(const ContactState& contacts, std::uint32_t body) {
  for (const NodalForce& f : contacts.forces)
    if (f.body == body) add(f.node, Eigen::Map<const Eigen::Vector3d>(f.force.data()).cast<float>());
}

void ColumnSum::combine(std::vector<Eigen::Vector3f>& displacement) {
  if (empty())
    std::ranges::fill(displacement, Eigen::Vector3f::Zero());
  else
    sum_.everywhere({displacement.data()->data(), 3 * displacement.size()});
}

}  // namespace palpate
