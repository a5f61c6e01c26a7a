#pragma once
#include "common/contact/patch/half_space.hpp"
#include "common/contact/patch/near_pairs.hpp"
#include "common/contact/patch/smooth_surface.hpp"

namespace palpate {

/// The half-space's compliance W^T G W among the nodes of a surface, with W_i = (4 phi_i - 1) / integral of phi_i over
/// the triangles about node i, which are dual to the surface's hats. Between nodes farther apart than their triangles'
/// size it is the kernel's own value; triangles that do not face the same way know nothing of each other.
class HatKernel {
 public:
  /// Among some nodes alone. `surface` outlives this object.
  HatKernel(const SmoothSurface& surface, const HalfSpace& half_space, const std::vector<bool>& nodes);

  Eigen::Matrix3d between(int i, int j) const;  ///< [m/N]
  /// [m/N] of nodes that are far from each other, of any surface.
  static Eigen::Matrix3d far(const SmoothSurface& surface, const HalfSpace& half_space, int i, int j);

 private:
  void integrate();

  const SmoothSurface& surface_;
  HalfSpace half_space_;
  std::vector<double> reach_;  ///< [m] per node, within which its triangles are integrated over
  NearPairs near_;
};

}  // namespace palpate
