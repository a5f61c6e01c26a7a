#include "common/contact/patch/local_motion.hpp"

#include <Eigen/SVD>

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastSpread = 1e-6;  // of the widest direction, below which the nodes lie on a line

/// Calls visit(node, weight) for the corners of all triangles nearby.
template <class Visit>
void for_each_corner(const SmoothSurface& surface, std::span<const int> triangles, const Vector3d& place, double within,
                     Visit&& visit) {
  for (const int t : triangles) {
    const Triangle c = surface.corners(t);
    const double area = (c[1] - c[0]).cross(c[2] - c[0]).norm();
    for (int v = 0; v < 3; ++v) {
      const double far = (c[v] - place).squaredNorm() / (within * within);
      if (far < 1) visit(surface.map().triangles[t][v], area * (1 - far) * (1 - far));
    }
  }
}

}  // namespace

// W. Kabsch 1976: the rotation from the singular vectors of the nodes' covariance.
Eigen::Isometry3d local_motion(const SmoothSurface& surface, const Vector3d& place, double within,
                               std::span<const Vector3d> positions) {
  const std::span<const int> near = surface.near(place, within);
  const auto& rest = surface.map().position;
  double sum = 0;
  Vector3d middle = Vector3d::Zero(), moved = Vector3d::Zero();
  for_each_corner(surface, near, place, within, [&](int node, double weight) {
    sum += weight;
    middle += weight * rest[node];
    moved += weight * (positions[node] - rest[node]);
  });
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (!(sum > 0)) return motion;
  middle /= sum;
  moved /= sum;
  Matrix3d covariance = Matrix3d::Zero();
  for_each_corner(surface, near, place, within, [&](int node, double weight) {
    const Vector3d arm = rest[node] - middle;
    covariance += weight * (arm + positions[node] - rest[node] - moved) * arm.transpose();
  });
  const Eigen::JacobiSVD<Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (svd.singularValues()[1] > kLeastSpread * svd.singularValues()[0]) {
    const Matrix3d turned = svd.matrixU() * svd.matrixV().transpose();
    const Vector3d signs(1, 1, turned.determinant() > 0 ? 1 : -1);
    motion.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  }
  motion.translation() = middle + moved - motion.linear() * middle;
  return motion;
}

}  // namespace palpate
