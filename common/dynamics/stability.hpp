#pragma once
#include "common/dynamics/dynamic_model.hpp"
#include "common/fem/elasticity.hpp"

namespace palpate {

/// Square of the largest angular frequency [rad^2/s^2] of one linear tetrahedron with lumped mass rho V/4 on
/// each corner: lambda_max(K_e) 4 / (rho V). The largest one over a mesh bounds every frequency of the
/// assembled mesh, fixed or not, because energy and mass are both sums over its tetrahedra.
double element_frequency_squared(const TetGradients& tet, const Lame& lame, double density);

/// The same of a tetrahedron whose strain is averaged at its nodes (NodalPatches): the mean over a patch takes no more
/// energy than its tetrahedra do by themselves, so that the largest one over a mesh bounds every frequency, whatever is
/// removed. Beside its strain energy a tetrahedron counts with c/2 V |F|^2, of which the patches give back what is not
/// a turn where 3 lambda + 2 mu >= c.
double averaged_frequency_squared(const TetGradients& tet, const Lame& lame, double stabilisation, double density);

}  // namespace palpate
