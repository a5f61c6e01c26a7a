#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "common/geometry/buckets.hpp"
#include "common/geometry/triangle.hpp"
#include "common/mesh/cut_mesh.hpp"

namespace palpate {

/// The moving surface of a body that is being cut, with buckets over its visible facets. Facets carry the
/// numbers of the CutMesh. No memory is taken after construction.
///
/// Each node of the surface stands in the buckets by a box somewhat larger than its present motion; only a
/// node that leaves its box costs more than a comparison.
class CutSurface {
 public:
  /// `mesh` outlives the surface; `rest` [m] has a place for each of its nodes; `bucket_size` [m] as for
  /// Buckets.
  CutSurface(const CutMesh& mesh, std::span<const Eigen::Vector3d> rest, double bucket_size);

  std::span<const Eigen::Vector3d> positions() const { return position_; }  ///< [m] world, per node
  /// Those before the last set_positions().
  std::span<const Eigen::Vector3d> previous() const { return previous_; }

  /// One step: the present positions become the previous ones, these the present ones.
  void set_positions(std::span<const Eigen::Vector3d> positions);
  /// Follows the last remove() or erase() of the mesh; called after each of them.
  void follow();

  /// Visible facets whose boxes, swept from the previous to the present positions, come within `radius` [m]
  /// of the box around a and b; ascending. The answer depends on the positions and the mesh alone. Valid
  /// until the next find().
  std::span<const int> find(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) const;

  Triangle corners(int facet) const { return of(position_, facet); }           ///< present
  Triangle previous_corners(int facet) const { return of(previous_, facet); }  ///< one step ago
  Eigen::Vector3d normal(int facet) const;  ///< outward, unit; zero of a collapsed facet
  /// Outward, unit, weighted by area; zero away from the surface.
  Eigen::Vector3d vertex_normal(int node) const;
  bool on_surface(int node) const { return facets_of_node_[node] > 0; }
  /// Calls visit(facet) for the visible facets of a node, ascending.
  template <class Visit>
  void for_each_facet_of(int node, Visit&& visit) const;

  const Buckets& buckets() const { return buckets_; }

 private:
  using Box = std::array<Eigen::Vector3d, 2>;

  Triangle of(const std::vector<Eigen::Vector3d>& x, int facet) const {
    const auto [a, b, c] = mesh_.facet(facet);
    return {x[a], x[b], x[c]};
  }
  bool fits(int node) const;
  void stand(int node);
  void enter(int facet);
  void find_bounds();

  const CutMesh& mesh_;
  std::vector<Eigen::Vector3d> position_, previous_;
  Buckets buckets_;
  double slack_;                     ///< [m] by which a node's box is larger than its motion
  Eigen::Vector3d low_, high_;       ///< [m] bounds of all living nodes, now and one step ago
  std::vector<Box> box_;             ///< per node on the surface
  std::vector<int> facets_of_node_;  ///< how many visible facets
  std::vector<int> leavers_;         ///< nodes that left their boxes in this step
  std::vector<int> entered_in_;      ///< per facet, the step in which it was last entered
  int step_ = 0;
  mutable std::vector<int> found_;
};

template <class Visit>
void CutSurface::for_each_facet_of(int node, Visit&& visit) const {
  for (int t : mesh_.around_node(node)) {
    if (!mesh_.alive(t)) continue;
    for (int f = 0; f < 4; ++f)
      if (mesh_.tetrahedron(t)[f] != node && mesh_.is_visible(4 * t + f)) visit(4 * t + f);
  }
}

}  // namespace palpate
