#pragma once
#include "common/dynamics/dynamic_model.hpp"
#include "common/fem/elasticity.hpp"

namespace palpate {

/// Square of the largest angular frequency [rad^2/s^2] of one linear tetrahedron with lumped mass rho V/4 on
/// each corner: lambda_max(K_e) 4 / (rho V). The largest one over a mesh bounds every frequency of the
/// assembled mesh, fixed or not, because energy and mass are both sums over its tetrahedra.
double element_frequency_squared(const TetGradients& tet, const Lame& lame, double density);

}  // namespace palpate
