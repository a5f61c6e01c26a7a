#include "common/geometry/direction.hpp"

#include <cmath>

namespace palpate {

double safe_length(const Eigen::Vector3d& v) {
  return v.stableNorm();
}

bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.stableNormalized().cross(b.stableNormalized()).norm() < 1e-6;
}

Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized(), b = to.normalized();
  const double cosine = b.dot(a);
  if (cosine < -1 + 1e-12) return Eigen::Quaterniond(Eigen::AngleAxisd(EIGEN_PI, a.unitOrthogonal()));
  const double twice = std::sqrt(2 * (1 + cosine));  // twice the cosine of half the angle
  Eigen::Quaterniond turn;
  turn.vec() = a.cross(b) * (1 / twice);
  turn.w() = twice * 0.5;
  return turn;
}

}  // namespace palpate
