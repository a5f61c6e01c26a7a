#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "common/contact/contact_surface.hpp"
#include "common/describe/state.hpp"
#include "common/geometry/buckets.hpp"
#include "common/mesh/cut_mesh.hpp"

namespace palpate {

/// The moving surface of a body that is being cut, with buckets over its visible facets: these are its triangles, and
/// carry the numbers of the CutMesh. No memory is taken after construction.
///
/// Each node of the surface stands in the buckets by a box somewhat larger than its present motion; only a
/// node that leaves its box costs more than a comparison.
class CutSurface : public ContactSurface {
 public:
  /// `mesh` outlives the surface; `rest` [m] has a place for each of its nodes; `bucket_size` [m] as for
  /// Buckets.
  CutSurface(const CutMesh& mesh, std::span<const Eigen::Vector3d> rest, double bucket_size);

  /// One step: the present positions become the previous ones, these the present ones.
  void set_positions(std::span<const Eigen::Vector3d> positions);
  /// Within a step: where a node is on its way to the present positions, for what asks about it alone.
  void place(int node, const Eigen::Vector3d& position);
  /// Present and previous positions. Throws std::runtime_error on a state of another surface.
  void state(State& s);
  /// Follows the last remove() or erase() of the mesh; called after each of them.
  void follow();

  /// Facets that nothing can touch from now on: find() leaves them out.
  void hide(std::span<const int> facets);
  /// Nodes that no force moves.
  void fix(int node) { touchable_[node] = 0; }

  /// The answer depends on the positions and the mesh alone.
  std::span<const int> find(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) const override;
  std::span<const int> find(const Segment& before, const Segment& now, double radius) const override;

  /// Unit, weighted by area; zero away from the surface.
  Eigen::Vector3d vertex_normal(int node) const override;
  Eigen::Vector3d outer_side(int node) const override { return vertex_normal(node); }
  Eigen::Vector3d outer_side(const std::array<int, 3>& nodes) const override;
  bool on_surface(int node) const { return facets_of_node_[node] > 0; }
  /// The visible facet that these nodes go round outward; -1: there is none.
  int facet_of(const std::array<int, 3>& nodes) const;
  /// Calls visit(facet) for the visible facets of a node, ascending.
  template <class Visit>
  void for_each_facet_of(int node, Visit&& visit) const;

  const Buckets& buckets() const { return buckets_; }

 private:
  using Box = std::array<Eigen::Vector3d, 2>;

  bool fits(int node) const;
  void stand(int node);
  void enter(int facet);
  void find_bounds();
  int collect(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double radius) const;

  const CutMesh& mesh_;
  Buckets buckets_;
  double slack_;                                         ///< [m] by which a node's box is larger than its motion
  Eigen::Vector3d low_, high_;                           ///< [m] bounds of all living nodes, now and one step ago
  std::vector<Box> box_;                                 ///< per node on the surface
  std::vector<int> facets_of_node_;                      ///< how many visible facets
  std::vector<std::pair<int, Eigen::Vector3d>> placed_;  ///< nodes that place() moved, and where they were
  std::vector<int> leavers_;                             ///< nodes that left their boxes in this step
  std::vector<int> entered_in_;                          ///< per facet, the step in which it was last entered
  int step_ = 0;
  std::vector<char> hidden_;  ///< per facet
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
