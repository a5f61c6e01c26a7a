#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace palpate {

// Compiled once: what Eigen makes of these is costly to parse wherever a header holds it.

/// Length of any vector of numbers, without overflow of its squares.
double safe_length(const Eigen::Vector3d& v);
/// Whether two directions of any length are parallel within 1e-6 rad; also if one of them is zero.
bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/// The least turn that takes one direction of any length into another.
Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace palpate
