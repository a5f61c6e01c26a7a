#pragma once
#include <Eigen/Core>

#include "common/scene/render_spec.hpp"

namespace palpate {

/// What a camera sees, in the world's frame: unit vectors, and what of the picture lies a metre ahead.
struct CameraAxes {
  Eigen::Vector3d right, up, forward;
  double half_height;  ///< [m]
};

/// Throws std::runtime_error if the camera looks nowhere.
CameraAxes axes_of(const Camera& camera);

}  // namespace palpate
