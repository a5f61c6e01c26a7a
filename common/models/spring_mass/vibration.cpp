#include "common/models/vibration.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/models/spring_mass/spec.hpp"

namespace palpate {

FreeVibration vibration(const SpringMassSpec& body) {
  throw std::runtime_error(
      fmt::format("body '{}' is of springs, whose modes are not computed: take it as tensor_mass", body.name));
}

}  // namespace palpate
