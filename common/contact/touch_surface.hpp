#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/describe/state.hpp"
#include "common/geometry/buckets.hpp"
#include "common/geometry/triangle.hpp"
#include "common/tool/tool_part.hpp"

namespace palpate {

/// The deformed surface of one body as the haptic loop knows it. Only the nodes near the tools are brought up to
/// date in each step, and a few others in turn; the rest keep their last known place. No memory is taken after
/// construction.
class TouchSurface {
 public:
  static constexpr int kRefreshedInTurn = 16;  ///< far nodes brought up to date per step

  TouchSurface(const SurfaceMap& map, double bucket_size);

  std::span<const Eigen::Vector3d> positions() const { return position_; }  ///< [m] world
  std::span<const Eigen::Vector3d> previous() const { return previous_; }   ///< [m] one step ago
  int triangle_count() const { return static_cast<int>(triangles_.size()); }
  const std::array<int, 3>& triangle(int t) const { return triangles_[t]; }
  Triangle corners(int t) const;           ///< present
  Triangle previous_corners(int t) const;  ///< one step ago
  std::array<Eigen::Vector3d, 2> swept_box(
      int t) const;                               ///< lowest and highest corner of the box that it sweeps in a step
  Eigen::Vector3d triangle_normal(int t) const;   ///< outward, not normalised
  Eigen::Vector3d vertex_normal(int node) const;  ///< outward, unit
  std::span<const Eigen::Vector3d> rest() const { return rest_; }                    ///< [m] positions at rest
  const Eigen::Vector3d& rest_normal(int node) const { return rest_normal_[node]; }  ///< vertex_normal() at rest
  Eigen::Vector3d rest_triangle_normal(const std::array<int, 3>& nodes) const;       ///< outward, unit, at rest

  /// Triangles whose boxes, swept from the previous to the present positions, come within `radius` [m] of a point on
  /// its way from a to b; ascending, a few others nearby among them.
  std::span<const int> find(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) const;
  /// The same for all points of a segment on its way from `before` to `now`. It is looked for in pieces, so that a long
  /// slanting segment does not bring in all that its box holds. Valid until the next call of either.
  std::span<const int> find(const Segment& before, const Segment& now, double radius) const;

  /// One update: begin, mark what is near, then move the marked nodes to rest + displacement.
  void begin_update();
  void mark_node(int node);
  void mark_triangles(std::span<const int> triangles);
  std::span<const int> marked() const { return marked_; }
  /// `displacement`: three entries [m] per marked node.
  void move_marked(std::span<const double> displacement);

  /// True if p lies inside the closed surface (parity of crossings along a ray).
  bool encloses(const Eigen::Vector3d& p) const;

  /// State for replay: previous and present positions and the turn of the far nodes.
  void state(State& s);

 private:
  void follow_restored();
  void enter(int triangle);
  int collect(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double radius) const;

  std::vector<Eigen::Vector3d> rest_, position_, previous_, rest_normal_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> first_of_node_, of_node_;  ///< triangles of each node, compressed
  int movable_;                               ///< nodes that can move: the touchable ones
  Buckets buckets_;
  double slack_;                                         ///< [m] by which boxes are entered larger than they are
  double piece_;                                         ///< [m] of a segment that is looked for at once
  Eigen::Vector3d low_, high_;                           ///< [m] box of all that the surface has reached so far
  std::vector<std::array<Eigen::Vector3d, 2>> entered_;  ///< per triangle, the box by which it stands in the buckets
  mutable std::vector<int> found_, found_along_, found_stamp_;
  mutable int found_clock_ = 0;
  std::vector<int> marked_, last_marked_, stamp_, triangle_stamp_;
  int clock_ = 0, triangle_clock_ = 0, turn_ = 0;
};

}  // namespace palpate
