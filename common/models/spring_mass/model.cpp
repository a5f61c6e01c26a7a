#include "common/dynamics/spring_mass.hpp"
#include "common/models/spring_mass/spec.hpp"

namespace palpate {

std::unique_ptr<DynamicModel> make_model(const SpringMassSpec& body, const ElasticMesh& mesh) {
  return make_in_precision<SpringMass>(mesh, body.dynamic);
}

}  // namespace palpate
