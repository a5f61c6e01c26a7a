#pragma once
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/fem/direct.hpp"
#include "common/fem/progress.hpp"
#include "common/models/quasi_static/spec.hpp"

namespace palpate {

/// Presses a body with a rigid frictionless ball at a few places of its surface, in six steps to its whole
/// radius, by linear and by neo-Hookean elasticity with the same constants, mesh and contact: the body's
/// own mesh with linear elements, made fine under the ball. A place's range ends where either law finds no equilibrium,
/// or where the force would fall while the ball advances; one without range is left out. Progress says how far each
/// went. Throws std::runtime_error if none has any.
std::vector<PressedPlace> press_by_laws(const StaticProblem& problem, const SurfaceMap& surface,
                                        const NeoHookeanLaw& law, const std::string& body, const Progress& progress);

}  // namespace palpate
