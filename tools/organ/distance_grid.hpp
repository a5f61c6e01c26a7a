#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace palpate {

/// Places of a grid's values: x fastest, then y, then z.
struct GridShape {
  std::array<int, 3> count{};  ///< along x, y, z
  Eigen::Vector3d origin;      ///< [m] place of the first value
  Eigen::Vector3d spacing;     ///< [m]

  std::size_t size() const { return static_cast<std::size_t>(count[0]) * count[1] * count[2]; }
  std::size_t index(int i, int j, int k) const { return (static_cast<std::size_t>(k) * count[1] + j) * count[0] + i; }
  Eigen::Vector3d place(int i, int j, int k) const { return origin + spacing.cwiseProduct(Eigen::Vector3d(i, j, k)); }
  std::array<int, 3> voxel_of(std::size_t index) const {
    const std::size_t row = count[0], layer = row * count[1];
    return {static_cast<int>(index % row), static_cast<int>(index % layer / row), static_cast<int>(index / layer)};
  }
  Eigen::Vector3d place_of(std::size_t index) const {
    const auto [i, j, k] = voxel_of(index);
    return place(i, j, k);
  }
  Eigen::Vector3d far_corner() const { return place(count[0] - 1, count[1] - 1, count[2] - 1); }
};

/// Values between which there are others.
struct ScalarGrid {
  GridShape shape;
  std::vector<float> value;

  /// Between the values evenly; outside of the grid as at its border.
  double at(const Eigen::Vector3d& x) const;
};
using DistanceGrid = ScalarGrid;  ///< distance to a surface [m], negative inside

/// Distance to the border between values that are set and others, which is taken to lie midway; exact but for that.
/// None may be set at the grid's rim, and one has to be.
DistanceGrid distance_to_border(const GridShape& shape, const std::vector<char>& inside);

/// Weighs every value with its neighbours by a Gaussian of deviation `width` [m] along each axis.
void smooth(ScalarGrid& grid, const Eigen::Vector3d& width);

/// [m^3] where the distance is less than `level`.
double volume_below(const DistanceGrid& grid, double level);

}  // namespace palpate
