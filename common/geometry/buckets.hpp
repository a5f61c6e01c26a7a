#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/segment.hpp"

namespace palpate {

/// Regular grid of buckets over a surface (TVCG99 sec. 5). Every triangle is entered in each bucket that its
/// swept bounding box (from the previous to the present node positions) meets, so that no crossing is missed.
/// All memory is taken in the constructor; move() and query() allocate nothing. One thread at a time.
///
/// A triangle whose box meets more than `kMaxBuckets` buckets, or for which no entries are left, goes on a
/// list that every query reads as a whole: slower, but nothing is lost.
class Buckets {
 public:
  static constexpr int kMaxBuckets = 64;

  /// `size` [m] is the edge of a bucket. The grid covers the surface's box grown by half its diagonal on all
  /// sides; what lies beyond is entered in the outermost buckets.
  /// Throws std::runtime_error if the size is not positive or gives more than 2^24 buckets.
  Buckets(std::span<const Eigen::Vector3d> positions, std::span<const std::array<int, 3>> triangles, double size);
  /// A grid around `positions` with no triangle in it, for triangles 0 ... `most` - 1 that come and go. Each has room
  /// in one bucket; `entries` more are shared.
  Buckets(std::span<const Eigen::Vector3d> positions, double size, int most, std::size_t entries);

  /// Enters the triangle, or its new swept box; does nothing if it meets the same buckets as before.
  void move(int triangle, const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max);
  /// Takes the triangle out of all buckets; move() enters it again.
  void remove(int triangle);

  /// Triangles whose buckets come within `radius` [m] of the box, each once, in no order, into `found`; returns how
  /// many. `found` needs room for every triangle of the surface.
  int query(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max, double radius, std::span<int> found) const;
  /// The same of a segment: buckets that come within `radius` of it along each axis, at one and the same place.
  int query(const Segment& segment, double radius, std::span<int> found) const;

  std::array<int, 3> cells() const { return cells_; }
  std::size_t bytes() const;  ///< memory taken
  /// Triangles on the list that every query reads.
  int overflow() const { return overflow_count_; }

 private:
  struct Range {
    std::array<int, 3> low{0, 0, 0}, high{-1, -1, -1};  ///< inclusive
    bool operator==(const Range&) const = default;
    int count() const { return (high[0] - low[0] + 1) * (high[1] - low[1] + 1) * (high[2] - low[2] + 1); }
  };
  /// A triangle in a bucket: a link of the bucket's list, which runs both ways, and of the triangle's own.
  struct Entry {
    int triangle, bucket, before, after, next_of_triangle;
  };

  void lay_grid(std::span<const Eigen::Vector3d> positions, double size);
  void take_entries(std::size_t count);
  template <class Visit>
  void for_each_bucket(const Range& range, Visit&& visit) const;
  Range range_of(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max) const;
  double apart(double low, double high, int index, int axis) const;
  Range range_to_look_at(const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max) const;
  /// Shares of the way along a segment.
  struct Piece {
    double from, to;
  };
  Piece along_layer(const Segment& segment, const Piece& piece, double reach, int index, int axis) const;
  void begin_query() const;
  int collect(int bucket, std::span<int> found, int count) const;
  void enter(int triangle);
  void leave(int triangle);
  void link(int triangle, int bucket);

  Eigen::Vector3d origin_;
  double size_, per_metre_;
  std::array<int, 3> cells_;
  Range filled_;                        ///< around all buckets that a triangle has ever been in, the overflow left out
  std::vector<int> first_in_bucket_;    ///< entry, or -1
  std::vector<Range> range_;            ///< per triangle; of one that is out it is empty
  std::vector<int> first_of_triangle_;  ///< entry, or -1
  std::vector<Entry> entries_;
  int free_ = -1, free_count_ = 0;
  int first_overflow_;  ///< the bucket behind the last: its list is that of the overflow
  int overflow_count_ = 0;
  mutable std::vector<std::uint32_t> stamp_;
  mutable std::uint32_t clock_ = 0;
};

}  // namespace palpate
