#include "common/geometry/direction.hpp"

namespace palpate {

double safe_length(const Eigen::Vector3d& v) {
  return v.stableNorm();
}

bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.stableNormalized().cross(b.stableNormalized()).norm() < 1e-6;
}

Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace palpate
