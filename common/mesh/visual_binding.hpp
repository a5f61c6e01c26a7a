#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace palpate {

/// What the vertices of a visual surface hang on. A cell is a tetrahedron, or a triangle (its fourth node is -1) of the
/// surface where the nodes behind it are not known.
struct VisualBinding {
  struct Tie {
    int cell = 0;
    std::array<float, 4> weight{};  ///< barycentric, of the cell's point that is nearest; none is negative, sum 1
    float distance = 0;             ///< [m] from there; 0 within a tetrahedron
  };
  std::vector<std::array<int, 4>> cells;  ///< nodes: the tetrahedra by their numbers, then the triangles
  int tetrahedra = 0;
  std::vector<Tie> ties;  ///< per vertex
};

/// Binds each vertex to the nearest of a body's tetrahedra and of those triangles of its surface that are no face of
/// one. `vertices` and `nodes`: [m] at rest. There is a cell at least.
VisualBinding bind_visual(std::span<const Eigen::Vector3f> vertices, std::span<const Eigen::Vector3d> nodes,
                          std::span<const std::array<int, 3>> triangles,
                          std::span<const std::array<int, 4>> tetrahedra);

}  // namespace palpate
