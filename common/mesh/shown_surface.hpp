#pragma once
#include <array>
#include <span>
#include <vector>

#include "common/mesh/cut_mesh.hpp"

namespace palpate {

/// The surface that is seen of a body of which a part, a CutMesh, can be cut: the rest of the body's surface, the
/// visible facets of the part, and what its removal lays bare of the rest. Facets by which the part is joined to the
/// rest are not seen.
class ShownSurface {
 public:
  /// `surface`: outward triangles of the whole body; `part`: before any cut.
  ShownSurface(std::span<const std::array<int, 3>> surface, const CutMesh& part);

  /// Outward triangles for the part as it is now. Valid until the next call.
  const std::vector<std::array<int, 3>>& triangles(const CutMesh& part);

  /// Facets by which the part is joined to the rest of the body; ascending.
  std::span<const int> joints() const { return joints_; }
  bool is_joint(int facet) const { return is_joint_[facet] != 0; }

 private:
  std::vector<std::array<int, 3>> of_rest_;
  std::vector<int> joints_;
  std::vector<char> is_joint_;  ///< per facet
  std::vector<std::array<int, 3>> triangles_;
};

}  // namespace palpate
