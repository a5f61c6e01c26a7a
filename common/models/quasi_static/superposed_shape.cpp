#include "common/models/quasi_static/superposed_shape.hpp"

#include <algorithm>

#include "common/kernels/kernels.hpp"

namespace palpate {
namespace {

std::span<float> flat(std::vector<Eigen::Vector3f>& field) {
  return {field.data()->data(), 3 * field.size()};
}

}  // namespace

Eigen::Vector3d press_direction(const ContactState& contacts, std::uint32_t body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const HeldContact& c : contacts.contacts) {
    if (c.body != body) continue;
    const Eigen::Map<const Eigen::Vector3d> force(c.force.data()), normal(c.normal.data());
    sum += force.dot(normal) * normal;
  }
  const double size = sum.norm();
  return size > 0 ? Eigen::Vector3d(sum / size) : Eigen::Vector3d::Zero();
}

SuperposedShape::SuperposedShape(const QuasiStaticSpec& body, const Archive& archive)
    : BodyShape(archive.surface), compliance_(archive, Compliance<float>::Rows::surface) {
  if (body.nonlinear) nonlinear_ = make_quasi_nonlinear(body, archive);
}

void SuperposedShape::add_columns(const ContactState& contacts, std::uint32_t body) {
  for (const NodalForce& f : contacts.forces) {
    if (f.body != body || static_cast<int>(f.node) >= compliance_.column_nodes()) continue;
    for (int axis = 0; axis < 3; ++axis) {
      columns_.push_back(compliance_.column(static_cast<int>(f.node), axis));
      coefficients_.push_back(static_cast<float>(f.force[axis]));
    }
  }
}

void SuperposedShape::combine(std::vector<Eigen::Vector3f>& out) const {
  kernels::active().combine_f(columns_.data(), coefficients_.data(), static_cast<int>(columns_.size()),
                              3 * static_cast<std::ptrdiff_t>(out.size()), out.data()->data());
}

void SuperposedShape::displace(const ContactsOnBody& contacts, std::vector<Eigen::Vector3f>& total) {
  columns_.clear();
  coefficients_.clear();
  for (const auto& [tool, state] : contacts.of_tool) add_columns(state, contacts.body);
  if (columns_.empty()) {
    std::ranges::fill(total, Eigen::Vector3f::Zero());
    return;
  }
  combine(total);
  if (nonlinear_) correct(contacts, total);
}

void SuperposedShape::correct(const ContactsOnBody& contacts, std::vector<Eigen::Vector3f>& total) {
  linear_ = total;
  of_tool_.resize(total.size());
  std::ranges::fill(total, Eigen::Vector3f::Zero());
  for (const auto& [tool, state] : contacts.of_tool) {
    columns_.clear();
    coefficients_.clear();
    add_columns(state, contacts.body);
    if (columns_.empty()) continue;
    combine(of_tool_);
    const Eigen::Vector3d press = press_direction(state, contacts.body);
    add_corrected<float>(*nonlinear_, flat(of_tool_), press, flat(total));
  }
  held_.clear();
  for (const auto& [tool, state] : contacts.of_tool)
    for (const NodalForce& f : state.forces)
      if (f.body == contacts.body) held_.push_back(static_cast<int>(f.node));
  keep_held<float>(held_, flat(linear_), flat(total));
}

std::unique_ptr<BodyShape> make_shape(const QuasiStaticSpec& body, const Archive& archive) {
  return std::make_unique<SuperposedShape>(body, archive);
}

}  // namespace palpate
