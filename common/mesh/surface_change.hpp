#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace palpate {

/// How far a closed surface is from its shape at rest.
struct SurfaceChange {
  double stretch = 0;   ///< [1] largest principal stretch within a triangle, or the inverse of the least, less 1
  double rotation = 0;  ///< [rad] largest rotation of a triangle, about any axis
  double volume = 0;    ///< [1] by which the volume inside has grown; of the volume at rest
};

/// A surface's triangles at rest, to compare others with.
class SurfaceAtRest {
 public:
  /// Triangles outward by the right-hand rule; `position` [m].
  SurfaceAtRest(const std::vector<Eigen::Vector3d>& position, std::vector<std::array<int, 3>> triangles);

  /// `position` [m] of the same nodes. Of each triangle the deformation gradient is split into rotation and stretch,
  /// its normal going along without stretch. About 60 flops a triangle; allocates nothing.
  SurfaceChange change(std::span<const Eigen::Vector3f> position) const;

 private:
  struct Frame {
    Eigen::Matrix<double, 3, 2> tangent;  ///< unit
    Eigen::Vector3d normal;               ///< unit, outward
    Eigen::Matrix2d from_edges;           ///< [1/m] inverse of the two edges at corner 0, in the tangents
  };
  static double six_volumes(const std::array<Eigen::Vector3d, 3>& corners);

  std::vector<std::array<int, 3>> triangles_;
  std::vector<Frame> frames_;  ///< per triangle
  double six_volumes_ = 0;     ///< [m^3]
};

}  // namespace palpate
