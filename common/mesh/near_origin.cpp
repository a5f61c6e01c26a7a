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

std::vector<Eigen::Vector3d> counted_from(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3d> points) {
  std::vector<Eigen::Vector3d> from(points.begin(), points.end());
  for (Eigen::Vector3d& p : from) p -= origin;
  return from;
}

std::vector<Eigen::Vector3f> places_from(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3d> places) {
  std::vector<Eigen::Vector3f> from;
  from.reserve(places.size());
  for (const Eigen::Vector3d& p : places) from.emplace_back((p - origin).cast<float>());
  return from;
}

}  // namespace palpate
