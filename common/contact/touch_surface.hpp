#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/contact/buckets.hpp"
#include "common/contact/triangle.hpp"
#include "common/tensors/archive.hpp"

namespace palpate {

/// The deformed surface of one body as the haptic loop knows it. Only the nodes near the tools are brought up to
/// date in each step, and a few others in turn; the rest keep their last known place. No memory is taken after
/// construction.
class TouchSurface {
 public:
  static constexpr int refreshed_in_turn = 16;  ///< far nodes brought up to date per step

  TouchSurface(const SurfaceMap& map, double bucket_size);

  std::span<const Eigen::Vector3d> positions() const { return position_; }  ///< [m] world
  int triangle_count() const { return static_cast<int>(triangles_.size()); }
  const std::array<int, 3>& triangle(int t) const { return triangles_[t]; }
  Triangle corners(int t) const;           ///< present
  Triangle previous_corners(int t) const;  ///< one step ago
  Eigen::Vector3d triangle_normal(int t) const;  ///< outward, not normalised
  Eigen::Vector3d vertex_normal(int node) const; ///< outward, unit

  /// Triangles whose boxes, swept from the previous to the present positions, come within `radius` [m] of a point on
  /// its way from a to b; ascending, a few others nearby among them.
  std::span<const int> find(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) const;

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
  std::size_t state_size() const { return 6 * sizeof(double) * position_.size() + sizeof(int); }
  void save(unsigned char* to) const;
  void restore(const unsigned char* from);

 private:
  void enter(int triangle);

  std::vector<Eigen::Vector3d> rest_, position_, previous_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> first_of_node_, of_node_;  ///< triangles of each node, compressed
  int movable_;                               ///< nodes that can move: the touchable ones
  Buckets buckets_;
  double slack_;                              ///< [m] by which boxes are entered larger than they are
  std::vector<std::array<Eigen::Vector3d, 2>> entered_;  ///< per triangle, the box by which it stands in the buckets
  mutable std::vector<int> found_;
  std::vector<int> marked_, last_marked_, stamp_, triangle_stamp_;
  int clock_ = 0, triangle_clock_ = 0, turn_ = 0;
};

}  // namespace palpate
