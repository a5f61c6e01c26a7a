#include "common/contact/patch/local_motion.hpp"

#include "common/geometry/nearest_rotation.hpp"

namespace palpate {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

constexpr double kMinSpread = 1e-6;  // of the widest direction, below which the nodes lie on a line

}  // namespace

// The rotation is that nearest to the nodes' covariance.
Eigen::Isometry3d local_motion(const SmoothSurface& surface, std::span<const int> near, const Vector3d& place,
                               double within, std::span<const Vector3d> positions) {
  const SurfaceMap& map = surface.map();
  Matrix4d moments = Matrix4d::Zero();  // of where the nodes are (rows) and rest (columns), from the place; last: of 1
  for (const int t : near)
    for (const int node : map.triangles[t]) {
      const Vector3d r = map.position[node] - place;
      const double far = r.squaredNorm() / (within * within);
      if (far >= 1) continue;
      const double weight = surface.area(t) * (1 - far) * (1 - far);
      const Vector3d x = r + (positions[node] - map.position[node]);
      moments.noalias() += (weight * x.homogeneous()) * r.homogeneous().transpose();
    }
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const double sum = moments(3, 3);
  if (!(sum > 0)) return motion;
  const Vector3d rest = moments.row(3).head<3>(), now = moments.col(3).head<3>();
  const NearestRotation nearest = nearest_rotation(moments.topLeftCorner<3, 3>() - now * rest.transpose() / sum);
  if (nearest.singular_values[1] > kMinSpread * nearest.singular_values[0]) motion.linear() = nearest.rotation;
  motion.translation() = place + now / sum - motion.linear() * (place + rest / sum);
  return motion;
}

}  // namespace palpate
