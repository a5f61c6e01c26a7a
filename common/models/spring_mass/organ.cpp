#include "common/models/moving/dynamic_organ.hpp"
#include "common/models/spring_mass/spec.hpp"

namespace palpate {

std::unique_ptr<DynamicOrgan> make_organ(const SpringMassSpec& body, const Archive& archive,
                                         const StepSettings& settings) {
  return std::make_unique<DynamicOrgan>(archive, body, settings, make_spring_model);
}

}  // namespace palpate
