#pragma once
#include <vector>

#include "common/fem/constraint.hpp"
#include "common/models/quasi_static/nonlinear.hpp"
#include "tools/solution_file.hpp"

namespace palpate {

/// Applies a body's quasi non-linear correction to a linear static state, as the nodes apply it to one tool's press
/// (TVCG99 sec. 4-3): all that is held presses along the direction of its resultant force F; every force is scaled by
/// Q(F)/F, the part of every displacement across the press by P, and what is held stays where it is held. Returns
/// Q(F)/F; 1, and nothing has changed, where the resultant is zero.
double correct_solution(const QuasiNonlinear& law, const std::vector<Constraint>& held, SolutionTable& table);

}  // namespace palpate
