#pragma once
#include <Eigen/Core>
#include <cmath>

namespace palpate {

/// Whether a point in the tip frame [m] lies between jaws of this length ahead of the tip's centre (and a quarter of it
/// behind) and this width across.
inline bool between_jaws(const Eigen::Vector3d& p, double length, double width) {
  return std::abs(p.x()) <= 0.5 * width && std::abs(p.y()) <= 0.5 * width && p.z() >= -0.25 * length && p.z() <= length;
}

/// Jaws that have closed stay closed until they open this much further [rad].
inline constexpr double kJawSlack = 0.03;

}  // namespace palpate
