#pragma once
#include <Eigen/Core>

#include "common/fem/assembly.hpp"

namespace palpate {

/// Lowest modes of K phi = omega^2 M phi with phi^T M phi = 1 over the free translations, rotations being
/// massless (BHS01 eq. 19; rotations condensed, eq. 16).
struct Modes {
  Eigen::VectorXd omega;  ///< [rad/s] ascending; a rigid motion of a free body has about 0
  Eigen::MatrixXd shape;  ///< [kg^-1/2] translations x modes; in each the first of the entries of largest
                          ///< size is positive
};

/// `stiffness`: lower triangle over translations and rotations, the translations first; `mass` [kg]: per
/// translation, positive. `shift` [1/s^2] > 0 is needed where rigid motions are free: K + shift M is
/// factorised. Shift-invert Lanczos (Spectra), repeated on what the modes found leave over until no lower
/// mode is left, since Lanczos may pass by copies of a repeated frequency; a dense solver where most modes
/// are wanted. Throws std::runtime_error if count is not in 1 .. translations, on a singular matrix, or
/// without convergence.
Modes lowest_modes(const SparseMatrix& stiffness, const Eigen::VectorXd& mass, int count, double shift = 0);

}  // namespace palpate
