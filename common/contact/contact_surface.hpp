#pragma once
#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "common/geometry/segment.hpp"
#include "common/geometry/triangle.hpp"

namespace palpate {

/// The moving surface of a body as tools meet it: triangles between nodes, where these are now and where they were a
/// step ago. Triangles and nodes keep their numbers for ever.
class ContactSurface {
 public:
  virtual ~ContactSurface() = default;

  int nodes() const { return static_cast<int>(position_.size()); }
  std::span<const Eigen::Vector3d> positions() const { return position_; }  ///< [m] world, per node
  std::span<const Eigen::Vector3d> previous() const { return previous_; }   ///< [m] one step ago
  std::span<const Eigen::Vector3d> rest() const { return rest_; }           ///< [m] of the undeformed body
  int triangle_count() const { return static_cast<int>(triangles_.size()); }
  const std::array<int, 3>& triangle(int t) const { return triangles_[t]; }  ///< outward by the right-hand rule
  Triangle corners(int t) const { return of(position_, t); }                 ///< present
  Triangle previous_corners(int t) const { return of(previous_, t); }        ///< one step ago
  /// Lowest and highest corner of the box that a triangle sweeps in a step.
  std::array<Eigen::Vector3d, 2> swept_box(int t) const;
  Eigen::Vector3d triangle_normal(int t) const;  ///< outward, not normalised
  /// Whether a force moves the node.
  bool touchable(int node) const { return touchable_[node] != 0; }

  virtual Eigen::Vector3d vertex_normal(int node) const = 0;  ///< outward, unit
  /// Outward, unit: the side of the tissue on which a node or triangle lies however the surface is folded there. Of
  /// tissue that keeps near its rest shape that at rest, of tissue that turns the present one.
  virtual Eigen::Vector3d outer_side(int node) const = 0;
  virtual Eigen::Vector3d outer_side(const std::array<int, 3>& nodes) const = 0;

  /// Triangles whose boxes, swept from the previous to the present positions, come within `radius` [m] of a point on
  /// its way from a to b; ascending, a few others nearby among them. Valid until the next call of either.
  virtual std::span<const int> find(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) const = 0;
  /// The same for all points of a segment on its way from `before` to `now`.
  virtual std::span<const int> find(const Segment& before, const Segment& now, double radius) const = 0;

 protected:
  ContactSurface(std::span<const Eigen::Vector3d> rest, std::vector<std::array<int, 3>> triangles)
      : rest_(rest.begin(), rest.end()),
        position_(rest_),
        previous_(rest_),
        triangles_(std::move(triangles)),
        touchable_(rest.size(), 1) {}

  Triangle of(const std::vector<Eigen::Vector3d>& x, int t) const {
    const auto& n = triangles_[t];
    return {x[n[0]], x[n[1]], x[n[2]]};
  }

  std::vector<Eigen::Vector3d> rest_, position_, previous_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<char> touchable_;  ///< per node
};

inline Eigen::Vector3d ContactSurface::triangle_normal(int t) const {
  const Triangle c = corners(t);
  return (c[1] - c[0]).cross(c[2] - c[0]);
}

inline std::array<Eigen::Vector3d, 2> ContactSurface::swept_box(int t) const {
  const auto& n = triangles_[t];
  Eigen::Vector3d low = position_[n[0]].cwiseMin(previous_[n[0]]), high = position_[n[0]].cwiseMax(previous_[n[0]]);
  for (int v = 1; v < 3; ++v) {
    low = low.cwiseMin(position_[n[v]]).cwiseMin(previous_[n[v]]);
    high = high.cwiseMax(position_[n[v]]).cwiseMax(previous_[n[v]]);
  }
  return {low, high};
}

}  // namespace palpate
