#include "tools/organ/canvas.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace palpate {

Canvas::Canvas(int width, int height, const Colour& ground)
    : image_{width, height, std::vector<std::uint8_t>(4 * static_cast<std::size_t>(width) * height, 255)},
      depth_(static_cast<std::size_t>(width) * height, std::numeric_limits<float>::infinity()) {
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) dot(x, y, ground);
}

void Canvas::dot(int x, int y, const Colour& colour) {
  if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
  std::uint8_t* const pixel = &image_.rgba[4 * (static_cast<std::size_t>(y) * image_.width + x)];
  for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(colour[c], 0.f, 1.f)));
}

void Canvas::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Colour& colour) {
  const int steps = std::max(1, static_cast<int>(std::ceil((b - a).cwiseAbs().maxCoeff())));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = a + static_cast<double>(i) / steps * (b - a);
    dot(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())), colour);
  }
}

void Canvas::triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                      const Colour& colour) {
  Eigen::Matrix3d corners;
  corners << a.head<2>(), b.head<2>(), c.head<2>(), 1, 1, 1;
  if (std::abs(corners.determinant()) < 1e-12) return;
  const Eigen::Matrix3d weights = corners.inverse();
  const auto first = [](double p, double q, double r) {
    return std::max(0, static_cast<int>(std::ceil(std::min({p, q, r}))));
  };
  const auto last = [](double p, double q, double r, int size) {
    return std::min(size - 1, static_cast<int>(std::floor(std::max({p, q, r}))));
  };
  for (int y = first(a.y(), b.y(), c.y()); y <= last(a.y(), b.y(), c.y(), image_.height); ++y)
    for (int x = first(a.x(), b.x(), c.x()); x <= last(a.x(), b.x(), c.x(), image_.width); ++x) {
      const Eigen::Vector3d w = weights * Eigen::Vector3d(x, y, 1);
      if (w.minCoeff() < 0) continue;
      const auto depth = static_cast<float>(w.dot(Eigen::Vector3d(a.z(), b.z(), c.z())));
      float& nearest = depth_[static_cast<std::size_t>(y) * image_.width + x];
      if (depth >= nearest) continue;
      nearest = depth;
      dot(x, y, colour);
    }
}

Image side_by_side(const Image& left, const Image& right) {
  Image both{left.width + right.width, left.height, {}};
  for (int y = 0; y < left.height; ++y)
    for (const Image* half : {&left, &right})
      both.rgba.insert(both.rgba.end(), half->pixel(0, y),
                       half->pixel(0, y) + 4 * static_cast<std::size_t>(half->width));
  return both;
}

}  // namespace palpate
