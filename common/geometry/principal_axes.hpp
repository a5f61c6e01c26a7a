#pragma once
#include <Eigen/Core>

namespace palpate {

/// Of a symmetric matrix, of which the lower half is read.
struct PrincipalAxes {
  Eigen::Vector3d values;  ///< in rising order
  Eigen::Matrix3d axes;    ///< columns, unit
};
PrincipalAxes principal_axes(const Eigen::Matrix3d& matrix);
Eigen::Vector3d principal_values(const Eigen::Matrix3d& matrix);

}  // namespace palpate
