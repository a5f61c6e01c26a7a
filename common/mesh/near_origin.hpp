#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

namespace palpate {

/// [m] Where places in single precision are counted from: of a grid of 16 m, the point nearest to the middle of these
/// points' box. So a body within 8 m is exact to half a micrometre wherever it is, and one about the world's origin is
/// counted from there.
Eigen::Vector3d near_origin(std::span<const Eigen::Vector3d> points);

/// The same places [m] from an origin on.
std::vector<Eigen::Vector3d> counted_from(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3d> points);

/// And in single precision.
std::vector<Eigen::Vector3f> places_from(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3d> places);

}  // namespace palpate
