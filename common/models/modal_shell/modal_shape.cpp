#include "common/models/modal_shell/modal_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace palpate {
const ModalTensors& modes_of(const Archive& archive) {
  if (!archive.modal || archive.modal->modes() == 0)
    throw std::runtime_error(fmt::format("body '{}': the archive holds no modes", archive.body));
  if (archive.modal->shape.size() != 3 * archive.surface.position.size() * archive.modal->omega.size())
    throw std::runtime_error(fmt::format("body '{}': the archive's modes are those of another surface", archive.body));
  return *archive.modal;
}

ModalShape::ModalShape(const Archive& archive)
    : compliance_(archive, Compliance<float>::Rows::surface),
      modes_(modes_of(archive).modes()),
      stride_(Compliance<float>::stride_of(archive.surface.size())),
      shape_(static_cast<std::size_t>(stride_) * modes_, 0.0f) {
  const std::ptrdiff_t rows = 3 * archive.surface.size();
  for (int m = 0; m < modes_; ++m)
    std::transform(archive.modal->shape.begin() + rows * m, archive.modal->shape.begin() + rows * (m + 1),
                   shape_.begin() + stride_ * m, [](double x) { return static_cast<float>(x); });
}

bool ModalShape::fits(const ModalState& state) const {
  const auto of_this = [&](const ShellForce& f) { return f.node < static_cast<std::uint32_t>(nodes()); };
  return state.coordinates.size() == static_cast<std::size_t>(modes_) && std::ranges::all_of(state.forces, of_this);
}

void ModalShape::displace(const ModalState& state, std::vector<Eigen::Vector3f>& displacement) {
  columns_.clear();
  coefficients_.clear();
  for (int m = 0; m < modes_; ++m) {
    columns_.push_back(mode(m));
    coefficients_.push_back(static_cast<float>(state.coordinates[m]));
  }
  for (const ShellForce& f : state.forces) {
    if (static_cast<int>(f.node) >= compliance_.column_nodes()) continue;
    for (int axis = 0; axis < 3; ++axis) {
      columns_.push_back(compliance_.column(static_cast<int>(f.node), axis));
      coefficients_.push_back(f.force[axis]);
    }
  }
  displacement.resize(nodes());
  kernels::active().combine_f(columns_.data(), coefficients_.data(), static_cast<int>(columns_.size()),
                              3 * static_cast<std::ptrdiff_t>(nodes()), displacement.data()->data());
}

}  // namespace palpate
