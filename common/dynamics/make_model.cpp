#include "common/dynamics/make_model.hpp"

#include "common/dynamics/corotational.hpp"
#include "common/dynamics/spring_mass.hpp"
#include "common/dynamics/tensor_mass.hpp"

namespace palpate {
namespace {

template <class Model>
std::unique_ptr<DynamicModel> make(const ElasticMesh& mesh, const Body& body) {
  auto model = std::make_unique<Model>(mesh, integrator_of(body), body.dynamic.damping);
  model->set_gravity(body.dynamic.gravity);
  return model;
}

template <class Scalar>
std::unique_ptr<DynamicModel> choose(const ElasticMesh& mesh, const Body& body) {
  if (body.model == "spring_mass") return make<SpringMass<Scalar>>(mesh, body);
  if (body.dynamic.corotational) return make<Corotational<Scalar>>(mesh, body);
  return make<TensorMass<Scalar>>(mesh, body);
}

}  // namespace

Integrator integrator_of(const Body& body) {
  return body.dynamic.integrator == "semi_implicit" ? Integrator::semi_implicit : Integrator::rk4;
}

std::unique_ptr<DynamicModel> make_dynamic_model(const ElasticMesh& mesh, const Body& body) {
  return body.dynamic.precision == "double" ? choose<double>(mesh, body) : choose<float>(mesh, body);
}

}  // namespace palpate
