#pragma once
#include <functional>

#include "common/fem/direct.hpp"

namespace palpate {

/// A body that swings freely about its rest shape: M u'' + K u = 0. See vibration() in common/models/kind.hpp.
struct FreeVibration {
  SparseMatrix stiffness;  ///< [N/m] lower triangle over the free dofs, those without mass last
  Eigen::VectorXd mass;    ///< [kg] lumped, per dof with mass
  double shift = 0;        ///< [1/s^2] > 0 where motions without elastic energy are free: see lowest_modes()
  /// M X with the mass of elements for which a lumped one is too coarse; empty: `mass` is all.
  std::function<Eigen::MatrixXd(const Eigen::MatrixXd& x)> consistent_mass;
};

/// Of tetrahedra: their own elements, a quarter of each one's mass at each of its nodes.
FreeVibration vibration_of(const StaticProblem& problem);

}  // namespace palpate
