#include "common/geometry/principal_axes.hpp"

#include <Eigen/Eigenvalues>

namespace palpate {

PrincipalAxes principal_axes(const Eigen::Matrix3d& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(matrix);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Eigen::Vector3d principal_values(const Eigen::Matrix3d& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace palpate
