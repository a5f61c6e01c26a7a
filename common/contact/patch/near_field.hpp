#pragma once
#include <vector>

#include "common/archive/compliance.hpp"
#include "common/contact/patch/hat_kernel.hpp"

namespace palpate {

/// [m] Half the width of a patch that covers all of a body, from its middle on: there is no more to be pressed.
double widest_patch(const SurfaceMap& map);

/// What a body's compliance among near surface nodes has beyond the half-space's,
///   K = S (C - W^T G W) S^T,
/// with C the archive's and W^T G W the half-space's between the same nodes (HatKernel). Under a patch of pressures of
/// its own, G takes the place of what the mesh cannot resolve, and K brings in the body's shape, its thickness and its
/// boundary conditions.
///
/// S averages over the nodes about each that look the same way. What C has beyond the half-space is smooth; what the
/// elements do wrong, too stiff for all that changes from edge to edge, is not. Without the average, edges finer than
/// the patch make that error larger than G itself, and G + K negative.
class NearField {
 public:
  /// For patches of parts of `radius` [m] at most; `resolved` [1]: over how many edges the elements behind C know the
  /// true compliance. All else outlives this object.
  NearField(const SmoothSurface& surface, const Compliance<double>& compliance, const HalfSpace& half_space,
            double radius, double resolved);
  /// K - C instead: for tissue whose nodes give way by themselves, by inertia now and by C once they are at rest. `C`
  /// need not live on.
  void subtract(const Compliance<double>& compliance);

  /// [m/N] symmetric under (i, j) and transposition. It is kept for nodes that are near each other; of others it is
  /// worked out, without an average: there the elements know what they do.
  Eigen::Matrix3d between(int i, int j) const;

  /// [bytes] that it will take.
  static std::size_t bytes_of(const SurfaceMap& map, double radius);

 private:
  Eigen::Matrix3d far(int i, int j) const;

  const SmoothSurface& surface_;
  const Compliance<double>* compliance_;  ///< null: subtracted
  HalfSpace half_space_;
  NearPairs pairs_;
};

}  // namespace palpate
