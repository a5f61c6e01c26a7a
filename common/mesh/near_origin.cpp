#include "common/mesh/near_origin.hpp"

#include <Eigen/Geometry>

namespace palpate {
namespace {

constexpr double kGrid = 16;  // [m]

}  // namespace

Eigen::Vector3d near_origin(std::span<const Eigen::Vector3d> points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : points) box.extend(p);
  if (box.isEmpty()) return Eigen::Vector3d::Zero();
  return kGrid * (box.center() / kGrid).array().round();
}

}  // namespace palpate
