#pragma once
#include <Eigen/Core>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/archive/compliance.hpp"
#include "common/kernels/kernels.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// What the archive holds of a wall's modes. Throws std::runtime_error if it holds none, or those of another surface.
const ModalTensors& modes_of(const Archive& archive);

/// The full displacement field of a thin wall from its reduced state: u = Phi X' + C f over the whole surface (BHS01
/// eq. 18 and the static share of the modes left out), in single precision.
class ModalShape {
 public:
  /// `archive`: read with ArchivePart::surface. Throws std::runtime_error if it holds no modes, or modes of another
  /// surface.
  explicit ModalShape(const Archive& archive);

  int modes() const { return modes_; }
  int nodes() const { return compliance_.row_nodes(); }
  /// Whether the state is of this wall: as many coordinates as modes, and forces at its nodes.
  bool fits(const ModalState& state) const;
  /// Fills `displacement` [m], nodes() long. A force where nothing can move has no effect. Allocates only when more
  /// nodes are loaded than ever before.
  void displace(const ModalState& state, std::vector<Eigen::Vector3f>& displacement);

 private:
  const float* mode(int m) const { return shape_.data() + stride_ * m; }

  Compliance<float> compliance_;
  int modes_;
  std::ptrdiff_t stride_;
  std::vector<float, kernels::LineAllocator<float>> shape_;  ///< a column per mode
  std::vector<const float*> columns_;
  std::vector<float> coefficients_;
};

}  // namespace palpate
