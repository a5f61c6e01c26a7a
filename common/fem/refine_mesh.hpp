#pragma once
#include <array>
#include <vector>

#include "common/fem/assembly.hpp"

namespace palpate {

/// The edges of a mesh, numbered by their lesser end and then by the other.
class EdgeNumbers {
 public:
  explicit EdgeNumbers(const TetMesh& mesh);

  int count() const { return static_cast<int>(ends_.size()); }
  const std::vector<std::array<int, 2>>& ends() const { return ends_; }  ///< the lesser node first
  /// Number of the edge between two nodes that share a tetrahedron.
  int operator()(int a, int b) const;

 private:
  std::vector<std::array<int, 2>> ends_;
  std::vector<int> first_;  // per node: the first edge of which it is the lesser end
};

/// Ends of the six edges of a tetrahedron, in the order of every list of edge midpoints here.
inline constexpr int kTetEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

/// A mesh whose tetrahedra are split into eight each. Nodes keep their numbers, and node `nodes before + i` is the
/// midpoint of ends[i]; tetrahedron e becomes 8 e .. 8 e + 7. Groups are left behind.
struct RefinedMesh {
  TetMesh mesh;
  std::vector<std::array<int, 2>> ends;
};

/// Cuts the four corners off every tetrahedron and the octahedron that is left along its shortest diagonal. The
/// surface stays on the flat faces of the mesh.
RefinedMesh split_in_eight(const TetMesh& mesh);

}  // namespace palpate
