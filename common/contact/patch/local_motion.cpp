#include "common/contact/patch/local_motion.hpp"

#include <Eigen/SVD>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastSpread = 1e-6;  // of the widest direction, below which the nodes lie on a line

}  // namespace

// W. Kabsch 1976: the rotation from the singular vectors of the nodes' covariance.
Eigen::Isometry3d local_motion(const SmoothSurface& surface, const Vector3d& place, double within,
                               std::span<const Vector3d> positions) {
  const SurfaceMap& map = surface.map();
  double sum = 0;
  Vector3d rest = Vector3d::Zero(), now = Vector3d::Zero();  // from the place
  Matrix3d covariance = Matrix3d::Zero();
  for (const int t : surface.near(place, within))
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
  const Eigen::JacobiSVD<Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()[1] > kLeastSpread * svd.singularValues()[0]) {
    const Matrix3d turned = svd.matrixU() * svd.matrixV().transpose();
    const Vector3d signs(1, 1, turned.determinant() > 0 ? 1 : -1);
    motion.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  }
  motion.translation() = place + now / sum - motion.linear() * (place + rest / sum);
  return motion;
}

}  // namespace palpate
