#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/contact/contact_surface.hpp"
#include "common/describe/state.hpp"
#include "common/geometry/buckets.hpp"

namespace palpate {

/// The deformed surface of one body as the haptic loop knows it. Only the nodes near the tools are brought up to
/// date in each step, and a few others in turn; the rest keep their last known place. No memory is taken after
/// construction.
class TouchSurface : public ContactSurface {
 public:
  static constexpr int kRefreshedInTurn = 16;  ///< far nodes brought up to date per step

  TouchSurface(const SurfaceMap& map, double bucket_size);

  Eigen::Vector3d vertex_normal(int node) const override;
  Eigen::Vector3d outer_side(int node) const override { return rest_normal_[node]; }
  Eigen::Vector3d outer_side(const std::array<int, 3>& nodes) const override;

  std::span<const int> find(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) const override;
  /// It is looked for in pieces, so that a long slanting segment does not bring in all that its box holds.
  std::span<const int> find(const Segment& before, const Segment& now, double radius) const override;

  /// One update: begin, mark what is near, then move the marked nodes to rest + displacement.
  void begin_update();
  void mark_node(int node);
  void mark_triangles(std::span<const int> triangles);
  void mark_all();
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

  std::vector<Eigen::Vector3d> rest_normal_;
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
