#pragma once
#include <string>

#include "common/dynamics/spec.hpp"

namespace palpate {

/// Of a core, what moving tissue takes at the most: the rest is the haptic node's, where they have one core
/// (CoreShare).
inline constexpr double kTissueShare = 0.8;

/// The steps in which the tissue of a moving body goes on.
struct TissueSteps {
  double bound;    ///< [s] up to which the scene's integrator is stable
  double free;     ///< [s] the scene's step, or a share of the bound
  double touched;  ///< [s] while tools touch it, by the semi-implicit rule
};

/// How many steps of at most `step` [s] a tick of `dt` [s] takes.
int steps_in(double dt, double step);

/// Of tissue whose angular frequencies stay below `frequency_bound` [rad/s]. Throws std::runtime_error naming the body
/// if the scene's step is not stable, with the bound.
TissueSteps tissue_steps(const std::string& body, const Dynamic& motion, double frequency_bound);

}  // namespace palpate
