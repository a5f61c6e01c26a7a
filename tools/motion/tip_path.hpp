#pragma once
#include <Eigen/Core>
#include <vector>

#include "common/tool/spec.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {

/// How far what touches first is before the origin of a tool's tip frame [m]: a forceps' jaws while they are shut.
double reach_of(const Tool& tool);

/// Where a trajectory leads a tool's tip [m], or the ends of its shut jaws.
struct TipPath {
  std::vector<Eigen::Vector3d> points;  ///< half a millimetre apart or more
  std::vector<Eigen::Vector3d> stands;  ///< where it begins, ends, and is slower than 1 mm/s between
};
TipPath tip_path(const Trocar& trocar, double reach, const Trajectory& motion);

}  // namespace palpate
