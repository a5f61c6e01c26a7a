#pragma once
#include "common/fem/condensation.hpp"
#include "common/models/hybrid/hybrid_split.hpp"

namespace palpate {

/// Fills in the tensors of CondensedTensors (bound, stiffness, reaction, follow, sag), whose `dofs` are given,
/// by one sparse factorisation of K_ii and blocks of right-hand sides. `rows`: mesh node and axis of the dofs
/// whose rows of H and u_g are stored; `columns`: mesh node and axis of CondensedTensors::dofs. `mass` [kg] and
/// `load` [N] of the quasi-static part per mesh node, its weight in it. Throws std::runtime_error if K_ii is singular.
void condense_on_connection(const HybridSplit& split, const MaterialField& materials, const std::vector<Dof>& rows,
                            const std::vector<Dof>& columns, const std::vector<double>& mass,
                            const std::vector<Eigen::Vector3d>& load, CondensedTensors& tensors);

}  // namespace palpate
