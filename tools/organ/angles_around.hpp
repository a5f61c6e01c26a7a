#pragma once
#include <span>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// What the tetrahedra at each node of a mesh are like while nodes are moved.
class AnglesAround {
 public:
  explicit AnglesAround(const TetMesh& mesh);

  std::span<const int> tetrahedra(int node) const { return around_[node]; }
  /// [degrees] The least dihedral angle at a node; 0 where a tetrahedron is turned over.
  double least(int node) const;

 private:
  const TetMesh& mesh_;
  std::vector<std::vector<int>> around_;
};

}  // namespace palpate
