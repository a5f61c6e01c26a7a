#pragma once
#include "bench/shell_bodies.hpp"
#include "common/fem/factorisation.hpp"

namespace palpate::testing {

using namespace palpate::bench;

/// Displacement under forces on the translations, without moments.
inline Eigen::VectorXd static_solution(const ShellSystem& system, const Eigen::VectorXd& force) {
  Factorisation factor(system.stiffness);
  factor.factorise(system.stiffness);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(system.stiffness.rows());
  load.head(force.size()) = force;
  return factor.solve(load).topRows(force.size());
}

}  // namespace palpate::testing
