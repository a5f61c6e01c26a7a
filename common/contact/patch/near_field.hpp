#pragma once
#include <vector>

#include "common/archive/compliance.hpp"
#include "common/contact/patch/hat_kernel.hpp"

namespace palpate {

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
  /// For patches of a ball of `radius` [m]; `resolved` [1]: over how many edges the elements behind C know the true
  /// compliance.
  NearField(const SmoothSurface& surface, const Compliance<double>& compliance, const HalfSpace& half_space,
            double radius, double resolved);
  /// K - C instead: for tissue whose nodes give way by themselves, by inertia now and by C once they are at rest.
  void subtract(const Compliance<double>& compliance);

  /// [m/N] symmetric under (i, j) and transposition; zero of nodes that are not near each other.
  Eigen::Matrix3d between(int i, int j) const;

  /// [bytes] that it will take.
  static std::size_t bytes_of(const SurfaceMap& map, double radius);

 private:
  NearPairs pairs_;
};

}  // namespace palpate
