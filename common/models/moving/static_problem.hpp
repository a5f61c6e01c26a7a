#pragma once
#include "common/dynamics/spec.hpp"
#include "common/fem/direct.hpp"

namespace palpate {

/// The body at rest, with the elements that it moves by. `moving`: tetrahedra of the mesh. Throws std::runtime_error as
/// make_static_problem does.
StaticProblem moving_problem(const MovingSpec& body, TetMesh mesh, const std::vector<int>& moving);
/// The same of a body that moves as a whole.
StaticProblem moving_problem(const MovingSpec& body, TetMesh mesh);

}  // namespace palpate
