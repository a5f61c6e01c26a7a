#pragma once
#include <Eigen/Core>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/fem/constraint.hpp"

namespace palpate {

/// A static state of the visible surface.
struct SurfaceSolution {
  std::vector<Eigen::Vector3d> displacement;  ///< [m] per surface node
  std::vector<Eigen::Vector3d> force;         ///< [N] per surface node, on the tissue, by the holds; reactions of
                                              ///< fixed axes are not in an archive and stay zero
};

/// Exact response to bilateral conditions J u = d and loads g through the compliance, in double precision:
///   lambda = (J C J^T)^-1 (d - J C g),  f = J^T lambda + g,  u = C f  (`f = C_cc^-1 u*` where single axes are held).
/// Both name mesh nodes. Throws std::runtime_error if a node is not a touchable surface node, a held axis is fixed, or
/// conditions repeat or contradict one another.
SurfaceSolution solve_tensors(const Archive& archive, const std::vector<Constraint>& constraints,
                              const std::vector<NodalLoad>& loads = {});

/// How TVCG99 combines the tensors of several held nodes.
enum class Superposition {
  plain,     ///< each node's own displacement, summed: overshoots where nodes are near (fig. 10, left)
  corrected  ///< with u~ = M^-1 u* of eq. 8 (fig. 10, right): exact
};

/// The paper's own way: u_n = sum T^u_nk u~_k (eq. 9), f_k = T^f_k u~_k (eq. 10 prints u*; its text says u~).
/// Takes conditions of one term each; the axes of one node form its block of the tensors.
SurfaceSolution superpose_tensors(const Archive& archive, const std::vector<Constraint>& holds, Superposition how);

/// Of a static state as lists with one entry a node, `node` their numbers: throws std::runtime_error with the first one
/// whose displacement or force is not finite.
void require_numbers(const std::vector<int>& node, const std::vector<Eigen::Vector3d>& displacement,
                     const std::vector<Eigen::Vector3d>& force);

}  // namespace palpate
