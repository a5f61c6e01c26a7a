#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace palpate {

/// Splits every triangle into four, as often as asked, and places the new vertices each frame on the curved
/// patch that the corner normals span (the edge rule of PN triangles, Vlachos et al. 2001). Corners stay
/// where they are, so what the eye sees stays where the hand feels it.
class Refinement {
 public:
  Refinement() = default;
  /// `vertices`: number of coarse vertices. Vertex order: the coarse ones, then those of each level. With `rest`
  /// positions of the coarse vertices, what lies at a crease (faces that meet at more than 50 degrees) stays flat:
  /// a sharp edge has no normal to bend by.
  Refinement(std::span<const std::array<int, 3>> triangles, int vertices, int levels,
             std::span<const Eigen::Vector3f> rest = {});

  int vertices() const { return coarse_ + static_cast<int>(edges_.size()); }
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }

  /// `position` [m] and unit `normal`, vertices() long, the coarse part filled in by the caller. Fills in the
  /// rest.
  void apply(std::span<Eigen::Vector3f> position, std::span<Eigen::Vector3f> normal) const;
  /// The same for one number per vertex, by the mean of the edge.
  void apply(std::span<float> scalar) const;

 private:
  void split();
  void mark_creases(std::span<const Eigen::Vector3f> rest);

  int coarse_ = 0;
  std::vector<std::array<int, 2>> edges_;  ///< per new vertex, ends before it in order
  std::vector<char> crease_;               ///< per vertex; empty: none
  std::vector<std::array<int, 3>> triangles_;
};

/// As many levels (0 to 2) as keep the triangles at or below `most`.
int refinement_levels(std::size_t triangles, std::size_t most);

}  // namespace palpate
