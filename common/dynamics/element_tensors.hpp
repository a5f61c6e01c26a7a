#pragma once
#include <span>
#include <utility>
#include <vector>

#include "common/dynamics/elastic_mesh.hpp"
#include "common/dynamics/numbering.hpp"
#include "common/fem/elasticity.hpp"

namespace palpate {

/// The linear tetrahedra of a mesh and the sums of their tensors and masses over those that remain. Every sum
/// is taken afresh in double precision in one fixed order, so that it depends on which tetrahedra remain and
/// on nothing else.
class ElementTensors {
 public:
  using Edge = std::array<int, 2>;              ///< nodes, the smaller first
  using Corners = Eigen::Matrix<double, 4, 3>;  ///< a vector per corner, in rows

  /// Throws std::runtime_error if a tetrahedron is flat or inverted, or its density is not positive.
  explicit ElementTensors(const ElasticMesh& mesh);

  int size() const { return static_cast<int>(tetrahedra_.size()); }
  bool alive(int t) const { return alive_[t]; }
  /// Takes a tetrahedron out; false if it was out already.
  bool remove(int t) { return std::exchange(alive_[t], 0) != 0; }

  const std::array<int, 4>& tetrahedron(int t) const { return tetrahedra_[t]; }
  const std::array<int, 6>& edges_of(int t) const { return edges_of_[t]; }
  std::span<const Edge> edges() const { return edges_; }
  std::span<const int> around_node(int n) const { return around_node_.of(n); }
  /// Index of the edge between two nodes, -1 if there is none.
  int edge_between(int a, int b) const;

  /// K_ab [N/m] of edge (a, b) over the remaining tetrahedra: force at a per displacement of b.
  Eigen::Matrix3d edge_tensor(int edge) const;
  /// Lumped mass [kg]: a quarter of each remaining tetrahedron's.
  double mass(int node) const;
  /// Whether some tetrahedron of the node remains.
  bool has(int node) const;

  double energy(int t, const Corners& u) const { return element_energy(gradients_[t], lame(t), u); }
  /// Elastic force [N] of the tetrahedron on its corner c.
  Eigen::Vector3d force(int t, int c, const Corners& u) const;

  /// Largest of the squared frequencies [rad^2/s^2] of all single tetrahedra, removed ones included.
  double frequency_squared() const { return frequency_squared_; }

 private:
  void find_edges();
  const Lame& lame(int t) const { return lame_[material_of_.empty() ? 0 : material_of_[t]]; }
  double density(int t) const { return density_[material_of_.empty() ? 0 : material_of_[t]]; }

  std::vector<std::array<int, 4>> tetrahedra_;
  std::vector<TetGradients> gradients_;
  std::vector<char> alive_;
  std::vector<Lame> lame_;       // per material
  std::vector<double> density_;  // per material
  std::vector<std::uint16_t> material_of_;
  std::vector<Edge> edges_;                   // ascending
  std::vector<std::array<int, 6>> edges_of_;  // of each tetrahedron, as kCornerPairs
  Incidence around_node_, around_edge_;       // tetrahedra, ascending
  double frequency_squared_ = 0;
};

}  // namespace palpate
