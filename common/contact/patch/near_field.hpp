#pragma once
#include <Eigen/Core>
#include <vector>

#include "common/archive/compliance.hpp"
#include "common/contact/patch/half_space.hpp"

namespace palpate {

/// What a body's compliance among near surface nodes has beyond the half-space's: K_ij = C_ij - W_i^T G W_j, with G the
/// half-space's kernel and W_i = (4 phi_i - 1) / integral of phi_i over the triangles about node i, which are dual to
/// the surface's hats. Under a patch of pressures of its own, G takes the place of what the mesh cannot resolve, and K
/// brings in the body's shape, its thickness and its boundary conditions.
class NearField {
 public:
  /// Of all pairs of nodes whose hats reach into one patch that is `width` [m] wide, wherever it lies.
  NearField(const SurfaceMap& map, const Compliance<double>& compliance, const HalfSpace& half_space, double width);

  /// [m/N] symmetric under (i, j) and transposition; zero of nodes that are not near each other.
  Eigen::Matrix3d between(int i, int j) const;

  /// [bytes] that it will take.
  static std::size_t bytes_of(const SurfaceMap& map, double width);
  std::size_t bytes() const { return blocks_.size() * sizeof blocks_[0] + neighbours_.size() * sizeof neighbours_[0]; }

 private:
  NearField(const SurfaceMap& map, double width);  ///< knows which pairs there are
  void find_edges(const SurfaceMap& map);
  void find_pairs(const SurfaceMap& map, double width);
  void take_half_space(const SurfaceMap& map, const HalfSpace& half_space, double width);
  int place(int i, int j) const;

  std::vector<double> edge_;             ///< [m] per node: its longest
  std::vector<int> first_, neighbours_;  ///< of node i, those j <= i that are near: neighbours_[first_[i] ..]
  std::vector<Eigen::Matrix3d> blocks_;  ///< like neighbours_
};

}  // namespace palpate
