#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace palpate {

/// Regular grid of buckets over a surface (TVCG99 sec. 5). Every triangle is entered in each bucket that its
/// swept bounding box (from the previous to the present node positions) meets, so that no crossing is missed.
/// All memory is taken in the constructor; move() and query() allocate nothing.
class Buckets {
 public:
  /// `size` [m] is the edge of a bucket. The grid covers the surface's box grown by half its diagonal on all
  /// sides; what lies beyond is entered in the outermost buckets.
  Buckets(std::span<const Eigen::Vector3d> positions, std::span<const std::array<int, 3>> triangles, double size);

  /// Enters the triangle's new swept box; does nothing if it meets the same buckets as before.
  void move(int triangle, const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max);

  /// Triangles whose buckets meet the box, ascending and without duplicates, into `found`; returns how many.
  int query(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max, std::span<int> found) const;
};

}  // namespace palpate
