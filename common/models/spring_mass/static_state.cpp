#include "common/models/static_state.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/models/spring_mass/spec.hpp"

namespace palpate {

DirectProblem direct_problem(const SpringMassSpec& body) {
  throw std::runtime_error(fmt::format(
      "body '{}' is a spring_mass: the direct method solves for linear elasticity, from which springs differ; its own "
      "rest is the end of its motion (palpate solve --dynamic)",
      body.name));
}

}  // namespace palpate
