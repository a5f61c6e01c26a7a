#pragma once
#include <vector>

#include "common/fem/assembly.hpp"
#include "common/fem/fine_space.hpp"

namespace palpate {

/// [kg] per mesh node: of each of its tetrahedra rho V/4.
std::vector<double> lumped_mass(const TetMesh& mesh, const MaterialField& materials);

/// [kg] per fine node, in proportion to the diagonal of the consistent mass (Hinton, Rock, Zienkiewicz 1976): of each
/// quadratic tetrahedron 1/36 at corners and 4/27 at midpoints. `materials` are those of the run-time tetrahedra.
std::vector<double> lumped_mass(const FineSpace& space, const MaterialField& materials);

}  // namespace palpate
