#include "render_node/camera_axes.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace palpate {

CameraAxes axes_of(const Camera& camera) {
  const Eigen::Vector3d forward = (camera.target - camera.eye).normalized();
  const Eigen::Vector3d sideways = forward.cross(camera.up);
  if (!(sideways.norm() > 1e-6 * camera.up.norm()))
    throw std::runtime_error("the camera looks nowhere: check its eye, target and up");
  const Eigen::Vector3d right = sideways.normalized();
  return {right, right.cross(forward), forward, std::tan(0.5 * camera.field_of_view * std::numbers::pi / 180)};
}

}  // namespace palpate
