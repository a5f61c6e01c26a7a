#pragma once
#include <array>
#include <string>
#include <vector>

#include "common/fem/solid_spec.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Numbers the free degrees of freedom of a mesh: fixed ones are eliminated axis by axis, and nodes that no
/// tetrahedron uses have none. Free numbers ascend with (node, axis).
class DofMap {
 public:
  static constexpr int kFixed = -1, kUnused = -2;

  /// Every used node free. Fix with fix(), then number().
  explicit DofMap(const TetMesh& mesh);
  /// The same for any nodes of which `used` says which ones elements use.
  explicit DofMap(const std::vector<char>& used);
  void fix(int node, int axis) { index_[3 * node + axis] = kFixed; }
  void number();

  /// Free number, kFixed or kUnused.
  int index(int node, int axis) const { return index_[3 * node + axis]; }
  bool is_free(int node, int axis) const { return index(node, axis) >= 0; }
  int nodes() const { return static_cast<int>(index_.size()) / 3; }
  int size() const { return static_cast<int>(dof_.size()); }
  /// 3 * node + axis of a free number.
  int dof(int index) const { return dof_[index]; }

 private:
  std::vector<int> index_, dof_;
};

/// The free dofs of a field over nodes.
Eigen::VectorXd gather(const DofMap& dofs, const std::vector<Eigen::Vector3d>& field);

/// Applies the boundary conditions of a body. `where` starts the error sentences. Throws std::runtime_error if a region
/// selects nothing, or if a rigid-body motion remains: the six rigid motions restricted to the fixed dofs
/// must be linearly independent.
DofMap apply_boundary_conditions(const TetMesh& mesh, const std::vector<BoundaryCondition>& regions,
                                 const std::string& where);

/// How many of the six rigid-body motions the fixed dofs leave free.
int remaining_rigid_motions(const TetMesh& mesh, const DofMap& dofs);

}  // namespace palpate
