#include "render_node/clear_corner.hpp"

#include <algorithm>
#include <array>

#include "render_node/camera_axes.hpp"

namespace palpate {
namespace {

constexpr double kWide = 0.58, kTall = 0.26;  // of the picture: what an overlay covers at most, about
constexpr double kStep = 2e-3;                // [m] along a shaft

constexpr std::array kCorners{Corner::upper_left, Corner::upper_right, Corner::lower_left, Corner::lower_right};

/// From (0, 0), the upper left corner, to (1, 1); far outside where it is behind the camera.
Eigen::Vector2d in_picture(const CameraAxes& axes, double aspect, const Eigen::Vector3d& from_eye) {
  const double depth = from_eye.dot(axes.forward), half = depth * axes.half_height;
  if (depth <= 0) return {-1, -1};
  return {0.5 + 0.5 * from_eye.dot(axes.right) / (half * aspect), 0.5 - 0.5 * from_eye.dot(axes.up) / half};
}

bool is_in(Corner corner, const Eigen::Vector2d& at) {
  const double x = is_right(corner) ? 1 - at.x() : at.x(), y = is_lower(corner) ? 1 - at.y() : at.y();
  return x >= 0 && x < kWide && y >= 0 && y < kTall;
}

}  // namespace

Corner clear_corner(const Camera& camera, std::span<const InstrumentView> instruments, double aspect) {
  const CameraAxes axes = axes_of(camera);
  std::array<int, kCorners.size()> seen{};
  for (const InstrumentView& tool : instruments)
    for (double back = 0; back < tool.shaft_length; back += kStep) {
      const Eigen::Vector2d at = in_picture(axes, aspect, tool.tip * Eigen::Vector3d(0, 0, -back) - camera.eye);
      for (std::size_t c = 0; c < kCorners.size(); ++c) seen[c] += is_in(kCorners[c], at);
    }
  return kCorners[std::ranges::min_element(seen) - seen.begin()];
}

}  // namespace palpate
