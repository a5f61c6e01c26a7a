#include "common/dynamics/make_model.hpp"

#include "common/dynamics/corotational.hpp"
#include "common/dynamics/spring_mass.hpp"
#include "common/dynamics/tensor_mass.hpp"

namespace palpate {
namespace {

template <class Model>
std::unique_ptr<DynamicModel> make(const ElasticMesh& mesh, const Dynamic& motion) {
  auto model = std::make_unique<Model>(mesh, integrator_of(motion), motion.damping);
  model->set_gravity(motion.gravity);
  return model;
}

template <class Scalar>
std::unique_ptr<DynamicModel> make_elements(const ElasticMesh& mesh, const Dynamic& motion) {
  if (motion.corotational) return make<Corotational<Scalar>>(mesh, motion);
  return make<TensorMass<Scalar>>(mesh, motion);
}

}  // namespace

Integrator integrator_of(const Dynamic& motion) {
  return motion.integrator == "semi_implicit" ? Integrator::semi_implicit : Integrator::rk4;
}

std::unique_ptr<DynamicModel> make_element_model(const ElasticMesh& mesh, const Dynamic& motion) {
  return motion.precision == "double" ? make_elements<double>(mesh, motion) : make_elements<float>(mesh, motion);
}

std::unique_ptr<DynamicModel> make_spring_model(const ElasticMesh& mesh, const Dynamic& motion) {
  if (motion.precision == "double") return make<SpringMass<double>>(mesh, motion);
  return make<SpringMass<float>>(mesh, motion);
}

}  // namespace palpate
