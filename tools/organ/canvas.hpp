#pragma once
#include <Eigen/Core>
#include <vector>

#include "render_node/image.hpp"

namespace palpate {

using Colour = Eigen::Array3f;  ///< red, green, blue, 0 to 1

/// A picture to draw into; places in pixels, (0, 0) the middle of the upper left one. What lies beyond is cut off.
class Canvas {
 public:
  Canvas(int width, int height, const Colour& ground = Colour::Zero());

  void dot(int x, int y, const Colour& colour);
  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Colour& colour);
  /// Corners with their depths; hides what is deeper, and is hidden by what is not.
  void triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, const Colour& colour);
  const Image& image() const { return image_; }

 private:
  Image image_;
  std::vector<float> depth_;
};

/// Two pictures of one height side by side.
Image side_by_side(const Image& left, const Image& right);

}  // namespace palpate
