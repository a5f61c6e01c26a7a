#include "common/geometry/nearest_rotation.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace palpate {

NearestRotation nearest_rotation(const Eigen::Matrix3d& f) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(f, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return {u * svd.matrixV().transpose(), svd.singularValues()};
}

}  // namespace palpate
