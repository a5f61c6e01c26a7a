#include "common/contact/patch/local_motion.hpp"

#include "common/geometry/nearest_rotation.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastSpread = 1e-6;  // of the widest direction, below which the nodes lie on a line

}  // namespace

// The rotation is that nearest to the nodes' covariance.
Eigen::Isometry3d local_motion(const SmoothSurface& surface, std::span<const int> near, const Vector3d& place,
                               double within, std::span<const Vector3d> positions) {
  const SurfaceMap& map = surface.map();
  double sum = 0;
  Vector3d rest = Vector3d::Zero(), now = Vector3d::Zero();  // from the place
  Matrix3d covariance = Matrix3d::Zero();
  for (const int t : near)
    for (const int node : map.triangles[t]) {
      const Vector3d r = map.position[node] - place;
      const double far = r.squaredNorm() / (within * within);
      if (far >= 1) continue;
      const double weight = surface.area(t) * (1 - far) * (1 - far);
      const Vector3d x = r + (positions[node] - map.position[node]);
      sum += weight;
      rest += weight * r;
      now += weight * x;
      covariance += weight * x * r.transpose();
    }
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (!(sum > 0)) return motion;
  covariance -= now * rest.transpose() / sum;
  const NearestRotation nearest = nearest_rotation(covariance);
  if (nearest.singular_values[1] > kLeastSpread * nearest.singular_values[0]) motion.linear() = nearest.rotation;
  motion.translation() = place + now / sum - motion.linear() * (place + rest / sum);
  return motion;
}

}  // namespace palpate
