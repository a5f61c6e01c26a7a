#pragma once
#include <vector>

#include "common/fem/assembly.hpp"

namespace palpate {

/// [kg] per mesh node: of each of its tetrahedra rho V/4.
std::vector<double> lumped_mass(const TetMesh& mesh, const MaterialField& materials);

}  // namespace palpate
