#pragma once
#include "common/shell/flat_triangle.hpp"

namespace palpate {

/// Elasticity matrix of plane stress [Pa]: (sxx, syy, sxy) from (exx, eyy, 2 exy).
Eigen::Matrix3d plane_stress(double young, double poisson);

/// Stiffness of the optimal membrane triangle with drilling freedoms (OPT: Felippa 2003, Computer Methods in
/// Applied Mechanics and Engineering 192, 2125). Dofs per corner: u, v [m] along the local x and y, and the
/// rotation [rad] about the local z, which means (dv/dx - du/dy)/2.
///
/// K = L E L^T / (A t) + (3/4) beta_0 T^T K_theta T. The first, basic part carries constant stress exactly
/// and takes its nodal forces from side displacements that are cubic in the rotations (alpha_b = 3/2); the
/// second answers the deviation of the rotations from the mean rotation, scaled so that bending in the plane
/// is exact at any aspect ratio. The rank is 6: the drilling rotation has a stiffness of its own, no penalty
/// is added.
///
/// `elasticity` [N/m]: plane stress times thickness.
Matrix9d membrane_stiffness(const FlatTriangle& triangle, const Eigen::Matrix3d& elasticity, double poisson);

}  // namespace palpate
