#pragma once
#include <Eigen/Core>
#include <vector>

#include "common/tool/trajectory.hpp"

namespace palpate {

/// Where a trajectory leads a tool's tip [m].
struct TipPath {
  std::vector<Eigen::Vector3d> points;  ///< half a millimetre apart or more
  std::vector<Eigen::Vector3d> stands;  ///< where it begins, ends, and is slower than 1 mm/s between
};
TipPath tip_path(const Trocar& trocar, const Trajectory& motion);

}  // namespace palpate
