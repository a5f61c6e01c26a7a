#pragma once
#include <Eigen/Core>

#include "common/fem/assembly.hpp"

namespace palpate {

/// K_tt - K_tr K_rr^-1 K_rt (BHS01 eq. 16), full and symmetric, translations x translations [N/m]: the
/// stiffness against forces when no moments act. `stiffness`: lower triangle, the translations first
/// (ShellDofs). Throws std::runtime_error if K_rr is not positive definite; with the drilling rotations' own
/// stiffness it always is.
Eigen::MatrixXd condense_rotations(const SparseMatrix& stiffness, int translations);

}  // namespace palpate
