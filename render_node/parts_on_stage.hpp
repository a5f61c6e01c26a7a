#pragma once
#include <array>
#include <span>
#include <vector>

namespace palpate {

/// Linear RGB of a body's parts where its colour says which is which (RR3510 fig. 7): what stands by precomputed
/// tensors, and what moves with inertia and can be cut.
inline constexpr std::array<double, 3> kPrecomputedColour{0.08, 0.22, 0.55}, kMovingColour{0.80, 0.40, 0.06};

/// Which triangles of a surface bound the tetrahedra that move, and the surface's wires.
class PartsOnStage {
 public:
  PartsOnStage() = default;
  /// `moving`: node indices of the tetrahedra that move, as the surface counts nodes.
  explicit PartsOnStage(std::span<const std::array<int, 4>> moving);

  /// Another surface over the same nodes, after a cut too.
  void sort(std::span<const std::array<int, 3>> triangles);

  std::span<const std::array<int, 3>> precomputed() const { return precomputed_; }
  std::span<const std::array<int, 3>> moving() const { return moving_; }
  /// Each edge of these triangles once: node indices.
  std::span<const std::array<int, 2>> precomputed_edges() const { return precomputed_edges_; }
  std::span<const std::array<int, 2>> moving_edges() const { return moving_edges_; }

 private:
  std::vector<std::array<int, 3>> faces_;  ///< of the tetrahedra that move: nodes ascending; ascending
  std::vector<std::array<int, 3>> precomputed_, moving_;
  std::vector<std::array<int, 2>> precomputed_edges_, moving_edges_;
};

}  // namespace palpate
