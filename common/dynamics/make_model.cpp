#include "common/dynamics/make_model.hpp"

#include "common/dynamics/corotational.hpp"
#include "common/dynamics/nodal_strain.hpp"
#include "common/dynamics/tensor_mass.hpp"

namespace palpate {

std::unique_ptr<DynamicModel> make_element_model(const ElasticMesh& mesh, const Dynamic& motion) {
  if (motion.corotational) return make_in_precision<Corotational>(mesh, motion);
  if (motion.element == TetElement::nodal_strain) return make_in_precision<NodalStrain>(mesh, motion);
  return make_in_precision<TensorMass>(mesh, motion);
}

}  // namespace palpate
