#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"

namespace palpate {

/// Coordinates [m] per surface node for a texture that runs along a thin wall. Of a tube (two mouths): z is the
/// distance along its centre line from the first mouth, x and y the place across it in a frame that does not twist. Of
/// any other shape: the rest positions, turned so that z runs along the longest extent.
std::vector<Eigen::Vector3f> straighten(const SurfaceMap& surface);

}  // namespace palpate
