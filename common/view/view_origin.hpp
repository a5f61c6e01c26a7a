#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"

namespace palpate {

/// [m] Where what is drawn of a scene is counted from, in single precision: near its first body.
Eigen::Vector3d view_origin(std::span<const Archive> bodies);

/// Places [m] from there on.
std::vector<Eigen::Vector3f> places_from(const Eigen::Vector3d& origin, std::span<const Eigen::Vector3d> places);

}  // namespace palpate
