#include "common/models/moving/tissue_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/dynamics/make_model.hpp"

namespace palpate {
namespace {

constexpr double kBoundShare = 0.9;  // of the largest stable step that is used where the scene names none

}  // namespace

int steps_in(double dt, double step) {
  return std::max(1, static_cast<int>(std::ceil(dt / step - 1e-9)));
}

TissueSteps tissue_steps(const std::string& body, const Dynamic& motion, double frequency_bound) {
  const double bound = max_step(motion.integrator, frequency_bound, motion.damping);
  if (motion.step > bound)
    throw std::runtime_error(
        fmt::format("body '{}': a step of {:.4g} s is not stable; the bound is {:.4g} s", body, motion.step, bound));
  const double free = motion.step > 0 ? motion.step : kBoundShare * bound;
  const double semi_implicit = max_step(Integrator::semi_implicit, frequency_bound, motion.damping);
  return {bound, free, std::min(free, kBoundShare * semi_implicit)};
}

}  // namespace palpate
