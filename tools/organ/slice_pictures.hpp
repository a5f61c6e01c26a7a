#pragma once
#include <filesystem>

#include "tools/organ/canvas.hpp"
#include "tools/organ/segmentation.hpp"

namespace palpate {

/// A slice enlarged to pixels by whole numbers, so that voxels have the shape that they have.
class SliceCanvas {
 public:
  /// `colour`: of the voxel in column i and row j.
  SliceCanvas(const GridShape& shape, const std::function<Colour(int i, int j)>& colour);

  void contour(const Contour& line, const Colour& colour);
  void segment(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Colour& colour);  ///< [voxels]
  void triangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                const Colour& colour);  ///< [voxels]
  void ruler();                         ///< marks at the upper and left border each ten voxels, longer ones each fifty
  const Image& image() const { return canvas_.image(); }

 private:
  Eigen::Vector2d pixel(const Eigen::Vector2d& x) const;

  std::array<int, 2> scale_;  ///< pixels a voxel
  Canvas canvas_;
};

/// Writes slice_0000.png and so on: grey values on the left, the steepness of the smoothed ones on the right, in both
/// where the contours started (dark) and where they are (bright; of another colour where drawn by hand).
/// Throws std::runtime_error where they cannot be written.
void write_slice_pictures(const ScalarGrid& image, const ScalarGrid& smoothed, const Segmentation& segmentation,
                          const std::filesystem::path& folder);

}  // namespace palpate
