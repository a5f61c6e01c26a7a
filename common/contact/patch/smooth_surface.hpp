#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/geometry/buckets.hpp"
#include "common/geometry/segment.hpp"
#include "common/geometry/triangle.hpp"

namespace palpate {

/// [m] Per node, the longest of its triangles' edges there.
std::vector<double> longest_edges(const SurfaceMap& map);

/// A body's surface at rest, with a normal that turns evenly from corner to corner.
class SmoothSurface {
 public:
  /// `map` outlives this object.
  explicit SmoothSurface(const SurfaceMap& map);

  const SurfaceMap& map() const { return map_; }
  Triangle corners(int t) const {
    const auto& n = map_.triangles[t];
    return {map_.position[n[0]], map_.position[n[1]], map_.position[n[2]]};
  }
  const Eigen::Vector3d& facet_normal(int t) const { return facet_[t].normal; }  ///< outward, unit
  Eigen::Vector3d normal(int t, const Eigen::Vector3d& weights) const;           ///< outward, unit, continuous
  const Eigen::Vector3d& node_normal(int n) const { return node_normal_[n]; }    ///< outward, unit
  bool touchable(int t) const { return std::ranges::min(map_.triangles[t]) < map_.touchable; }
  double area(int t) const { return area_[t]; }      ///< [m^2]
  double weight(int n) const { return weight_[n]; }  ///< [m^2] integral of its hat

  /// Triangles that come within `radius` of a point, or of a segment; ascending, a few others among them. Valid until
  /// the next call, and the caller's till then.
  std::span<int> near(const Eigen::Vector3d& point, double radius) const;
  std::span<int> near(const Segment& segment, double radius) const;
  /// Whether the line through a point along `way`, a unit, may come within `radius` of a triangle: false where it
  /// passes farther from the ball about its corners.
  bool may_meet(int t, const Eigen::Vector3d& point, const Eigen::Vector3d& way, double radius = 0) const {
    const Facet& f = facet_[t];
    const double far = kRounding * (f.reach + radius);
    return way.cross(f.middle - point).squaredNorm() <= far * far;
  }
  /// The triangle beyond the edge from a corner to the next; -1: none, or several.
  int across(int t, int corner) const { return across_[t][corner]; }
  /// Whether a triangle faces `way`, a unit, and those beyond its edges too; false where it is not known without them.
  bool faces_with_all_about(int t, const Eigen::Vector3d& way, double facing) const {
    return facet_[t].normal.dot(way) - facet_[t].bend > facing;
  }
  /// A triangle that is no longer there: near() leaves it out.
  void leave_out(int t);
  bool is_left_out(int t) const { return left_out_[t] != 0; }

 private:
  static constexpr int kNone = -1;
  static constexpr double kRounding = 1 + 1e-6, kEnds = 2;
  void find_across();
  /// What is asked of a triangle first.
  struct Facet {
    Eigen::Vector3d normal, middle;  ///< [m]
    double reach;                    ///< [m] of its corners from the middle
    double bend;  ///< largest difference from the normals beyond its edges; 2: the surface ends there
  };

  const SurfaceMap& map_;
  std::vector<Facet> facet_;  ///< per triangle
  std::vector<Eigen::Vector3d> node_normal_;
  std::vector<std::array<Eigen::Vector3d, 2>> box_;  ///< [m] per triangle: its lowest and its highest corner
  std::vector<std::array<int, 3>> across_;           ///< per triangle and corner
  std::vector<double> area_, weight_;
  std::vector<char> left_out_;  ///< per triangle
  Buckets buckets_;
  mutable std::vector<int> found_;
};

}  // namespace palpate
