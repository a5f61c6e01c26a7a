#pragma once
#include <Eigen/Core>

namespace palpate {

struct NearestRotation {
  Eigen::Matrix3d rotation;         ///< R that maximises tr(R^T F); det R = 1
  Eigen::Vector3d singular_values;  ///< of F, falling
};
/// Of any F, also where it is singular or mirrors (W. Kabsch 1976).
NearestRotation nearest_rotation(const Eigen::Matrix3d& f);

}  // namespace palpate
