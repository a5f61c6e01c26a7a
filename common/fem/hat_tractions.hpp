#pragma once
#include <functional>

#include "common/fem/assembly.hpp"
#include "common/fem/fine_space.hpp"

namespace palpate {

/// How a surface node of the run-time mesh weighs the fine displacements around it, and spreads its force over them.
enum class SurfaceWeight {
  dual,  ///< 4 phi_i - 1 on every run-time triangle at node i: dual to the hats, int psi_i phi_j = delta_ij int phi_i
  hat    ///< the linear hat phi_i itself
};

/// W: consistent nodal loads of the tractions psi_i / int phi_i, whose resultant is 1, fine nodes x run-time nodes, the
/// same for each axis. Its transpose takes fine displacements to those of the run-time nodes. With the dual weights a
/// field that is linear on the run-time triangles keeps its nodal values (so that linear elements on the run-time mesh
/// itself give its nodal compliance), and forces int phi_i t act like the traction t; mere hats average such a field,
/// and smear such a traction, over the neighbours. Column i of an inner node picks that node out; of a node that no
/// tetrahedron uses it is empty.
SparseMatrix hat_tractions(const FineSpace& space, const TetMesh& run_time_mesh,
                           SurfaceWeight weight = SurfaceWeight::dual);

/// A face of the fine surface: three corners, outward by the right-hand rule, then with quadratic displacements the
/// midpoints of the edges 01, 12 and 20.
struct FineFace {
  std::array<int, 6> node;
  int count;    ///< 3 or 6
  int element;  ///< that it bounds
};

std::vector<FineFace> fine_surface(const FineSpace& space);

/// The three corners of the run-time triangle that a fine face lies in.
std::array<int, 3> run_time_corners(const FineSpace& space, const FineFace& face);

/// Traction [Pa] at a point of the surface with an outward unit normal.
using Traction = std::function<Eigen::Vector3d(const Eigen::Vector3d& point, const Eigen::Vector3d& normal)>;

/// Consistent loads [N] per fine node of a traction, exact where it is a quadratic function of the place.
std::vector<Eigen::Vector3d> traction_loads(const FineSpace& space, const Traction& traction);

}  // namespace palpate
