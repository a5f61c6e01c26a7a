#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

/// What CGAL does with surfaces, behind plain types: its headers take a minute to compile.
namespace palpate {

/// Turns triangles so that neighbours agree; where three or more meet in an edge, or two parts in a node, the nodes
/// there are doubled and the copies put behind the others. Their number stays.
void orient_triangles(TriangleMesh& mesh);

/// Triangles that close a loop of points, as indices into it, wound as the loop is. Empty: it cannot be closed.
std::vector<std::array<int, 3>> close_loop(const std::vector<Eigen::Vector3d>& loop);

/// Pairs of triangles that cross one another, of a surface whose edges have two triangles at most; what merely touches
/// in corners or an edge at the same places does not cross.
std::vector<std::pair<int, int>> crossing_triangles(const TriangleMesh& mesh);

/// A closed, oriented surface that is asked again and again.
class SurfaceTree {
 public:
  explicit SurfaceTree(const TriangleMesh& mesh);
  ~SurfaceTree();
  SurfaceTree(SurfaceTree&&) noexcept;

  double distance(const Eigen::Vector3d& x) const;  ///< [m] to the surface; >= 0
  /// [m] That distance, or `most`, whichever is less: nothing farther is looked at.
  double distance(const Eigen::Vector3d& x, double most) const;
  Eigen::Vector3d nearest(const Eigen::Vector3d& x) const;
  /// The same in less time from a point of the surface that is not much farther from x.
  Eigen::Vector3d nearest(const Eigen::Vector3d& x, const Eigen::Vector3d& guess) const;
  int winding(const Eigen::Vector3d& x) const;  ///< how often the surface goes round x; 0 outside
  /// Where the line from x along the x axis goes through the surface: places along it [m], ascending, with +1 where it
  /// goes in and -1 where it goes out.
  std::vector<std::pair<double, int>> crossings_along_x(const Eigen::Vector3d& x) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace palpate
