#pragma once
#include <Eigen/Core>

#include "common/fem/assembly.hpp"
#include "common/fem/fine_space.hpp"

namespace palpate {

/// M X over the free dofs [kg] with the consistent mass of quadratic elements with straight edges, rho int N_i N_j.
/// `materials` are those of the run-time tetrahedra.
Eigen::MatrixXd times_consistent_mass(const FineSpace& space, const MaterialField& materials, const DofMap& dofs,
                                      const Eigen::MatrixXd& x);

}  // namespace palpate
