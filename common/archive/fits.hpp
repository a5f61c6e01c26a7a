#pragma once
#include <array>
#include <span>

#include "common/archive/archive.hpp"

namespace palpate {

/// Questions to the whole numbers of an archive that was read. Private to common/archive.
inline bool within(int node, int nodes) {
  return node >= 0 && node < nodes;
}

template <std::size_t N>
bool all_within(const std::array<int, N>& row, int nodes) {
  for (const int node : row)
    if (!within(node, nodes)) return false;
  return true;
}

/// Free dofs of nodes begin .. end-1, ascending: none twice.
inline bool are_free_dofs(std::span<const Dof> dofs, const SurfaceMap& surface, int begin, int end) {
  int before = -1;
  for (const Dof& dof : dofs) {
    if (dof.node < begin || dof.node >= end || !within(dof.axis, 3) || surface.fixed[dof.node][dof.axis]) return false;
    if (3 * dof.node + dof.axis <= before) return false;
    before = 3 * dof.node + dof.axis;
  }
  return true;
}

/// The lower triangle, packed by rows, of a symmetric matrix of n rows that may be positive definite: what is beside
/// the diagonal is no larger than that allows, up to rounding.
bool is_packed_compliance(std::span<const double> triangle, std::size_t n);

}  // namespace palpate
