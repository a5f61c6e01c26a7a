#pragma once
#include <Eigen/Core>
#include <span>

#include "common/archive/archive.hpp"

namespace palpate {

/// [m] Where what is drawn of a scene is counted from, in single precision: near its first body.
Eigen::Vector3d view_origin(std::span<const Archive> bodies);

}  // namespace palpate
