#include "common/models/quasi_static/column_sum.hpp"

#include <algorithm>

#include "common/kernels/kernels.hpp"

namespace palpate {

void ColumnSum::clear() {
  columns_.clear();
  coefficients_.clear();
}

void ColumnSum::add(std::uint32_t node, const Eigen::Vector3f& force) {
  if (static_cast<int>(node) >= compliance_.column_nodes()) return;
  for (int axis = 0; axis < 3; ++axis) {
    columns_.push_back(compliance_.column(static_cast<int>(node), axis));
    coefficients_.push_back(force[axis]);
  }
}

void ColumnSum::add(const ContactState& contacts, std::uint32_t body) {
  for (const NodalForce& f : contacts.forces)
    if (f.body == body) add(f.node, Eigen::Map<const Eigen::Vector3d>(f.force.data()).cast<float>());
}

void ColumnSum::combine(std::vector<Eigen::Vector3f>& displacement) const {
  if (empty()) {
    std::ranges::fill(displacement, Eigen::Vector3f::Zero());
    return;
  }
  kernels::active().combine_f(columns_.data(), coefficients_.data(), static_cast<int>(columns_.size()),
                              3 * static_cast<std::ptrdiff_t>(displacement.size()), displacement.data()->data());
}

}  // namespace palpate
