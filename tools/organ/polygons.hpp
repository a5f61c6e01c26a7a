#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace palpate {

/// A surface as files have it.
struct Polygons {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> polygons;  ///< indices into points

  /// Adds the triangles of a strip: each of its corners makes one with the two before it, every other one turned.
  void add_strip(const std::vector<int>& strip) {
    for (std::size_t c = 2; c < strip.size(); ++c)
      polygons.push_back({strip[c - 2], strip[c - 1 + c % 2], strip[c - c % 2]});
  }
};

/// Cuts a polygon that lies nearly in a plane into triangles without an overlap, wound as it is: a fan where it is
/// convex. One that crosses itself, which has no inside, becomes some triangles.
std::vector<std::array<int, 3>> cut_polygon(const std::vector<Eigen::Vector3d>& points,
                                            const std::vector<int>& polygon);

}  // namespace palpate
