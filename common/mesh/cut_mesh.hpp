#pragma once
#include <array>
#include <span>
#include <vector>

namespace palpate {

/// Topology of a tetrahedral mesh that is cut by taking tetrahedra out of it. Nodes and tetrahedra keep their
/// numbers for ever. Facets are numbered 4 t + f: face f of tetrahedron t lies opposite to its vertex f and
/// is oriented outward.
///
/// The mesh stays manifold: around every node with a tetrahedron left, these hang together through faces, and
/// their faces towards the outside form one closed fan or there are none. So no two parts are joined by a
/// node or an edge alone, every edge of the surface has two facets, and a node that loses its last
/// tetrahedron is out of the mesh. A mesh that is not manifold from the start is brought in order where it is
/// cut.
///
/// All memory is taken at construction; a removal works on the surroundings of what it removes.
class CutMesh {
 public:
  /// Tetrahedra are positively oriented, their nodes below `nodes`.
  /// Throws std::runtime_error if a node does not exist or a face belongs to more than two tetrahedra.
  CutMesh(std::span<const std::array<int, 4>> tetrahedra, int nodes);

  int nodes() const { return static_cast<int>(alive_around_.size()); }
  int size() const { return static_cast<int>(tetrahedra_.size()); }  ///< tetrahedra, dead ones included
  int alive_count() const { return alive_count_; }
  bool alive(int t) const { return alive_[t]; }
  const std::array<int, 4>& tetrahedron(int t) const { return tetrahedra_[t]; }
  /// Original tetrahedra of the node, dead ones included, ascending.
  std::span<const int> around_node(int n) const {
    return std::span(around_).subspan(first_around_[n], first_around_[n + 1] - first_around_[n]);
  }
  bool has_node(int n) const { return alive_around_[n] > 0; }  ///< some tetrahedron of it is alive

  /// The mesh is part of a larger body, which does not change and hangs on these visible facets: what would hang on it
  /// by a node or an edge alone goes as well. Call it before any removal.
  void join(std::span<const int> facets);

  /// Removes t, then those further ones that keep the mesh manifold: few, not always the fewest. Appends all
  /// of them to `removed` in order; they depend on the living tetrahedra alone. Nothing happens if t is dead.
  void remove(int t, std::vector<int>& removed);
  /// Removes exactly these, dead ones skipped: a list that remove() made elsewhere.
  void erase(std::span<const int> tetrahedra);

  /// Facets of the surface, dense; their order depends on the history.
  std::span<const int> visible() const { return visible_; }
  bool is_visible(int facet) const { return place_[facet] >= 0; }
  std::array<int, 3> facet(int id) const;  ///< its nodes, outward by the right-hand rule
  /// Changes of the surface by the last remove() or erase(), each facet once.
  std::span<const int> appeared() const { return appeared_; }
  std::span<const int> vanished() const { return vanished_; }

  /// Parts that hang together through faces, numbered by their first tetrahedra; -1 for dead ones. Returns
  /// how many.
  int parts(std::vector<int>& part_of_tetrahedron) const;

 private:
  void join_faces();
  void kill(int t);
  void show(int facet);
  void hide(int facet);
  void update_surface(std::span<const int> killed);

  bool outside(int facet) const { return across_[facet] < 0 || !alive_[across_[facet] / 4]; }
  bool repair(int node);
  bool drop_unjoined(int node);
  bool drop_unjoined(int node, int other);
  bool is_manifold_at(int node);
  int gather(int node, int other);
  bool keep_largest_group(int node, int other);
  bool part_fans(int node);
  bool open_between_rims(int node);
  int rim(int node);

  std::vector<std::array<int, 4>> tetrahedra_;
  std::vector<int> first_around_, around_;  ///< tetrahedra of each node, compressed
  std::vector<int> across_;                 ///< per facet: the same face as a facet of the other tetrahedron, or -1
  std::vector<char> alive_;
  std::vector<int> alive_around_;                ///< per node: living tetrahedra
  std::vector<char> is_joint_, is_joint_node_;   ///< per facet and node; empty: not joined to anything
  std::vector<std::array<int, 2>> joint_edges_;  ///< ascending
  std::vector<char> joined_;                     ///< per group, while joints are looked at
  int alive_count_;
  std::vector<int> visible_, place_;  ///< place_: per facet, where it stands in visible_, or -1
  std::vector<int> appeared_, vanished_, killed_;

  // Work space of repairs.
  std::vector<int> pending_;  ///< nodes to look at
  std::vector<char> is_pending_;
  std::vector<int> star_, queue_;  ///< tetrahedra around the node at hand
  std::vector<int> group_size_;
  std::vector<int> group_, from_, depth_;  ///< per tetrahedron
  std::vector<int> count_, rim_;           ///< per node; count_ is zero between uses
};

}  // namespace palpate
