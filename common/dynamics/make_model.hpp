#pragma once
#include <functional>
#include <memory>

#include "common/dynamics/dynamic_model.hpp"
#include "common/dynamics/elastic_mesh.hpp"
#include "common/dynamics/spec.hpp"

namespace palpate {

/// Makes a model of one body on a mesh.
using MakeModel = std::function<std::unique_ptr<DynamicModel>(const ElasticMesh& mesh)>;

/// A Model<float> or Model<double>, as `motion` asks, made from `mesh`, the integrator, the damping and `more`.
template <template <class> class Model, class... More>
std::unique_ptr<DynamicModel> make_in_precision(const ElasticMesh& mesh, const Dynamic& motion, const More&... more) {
  const auto make = [&]<class Scalar>(Scalar) -> std::unique_ptr<DynamicModel> {
    auto model = std::make_unique<Model<Scalar>>(mesh, motion.integrator, motion.damping, more...);
    model->set_gravity(motion.gravity);
    return model;
  };
  return motion.precision == Precision::float64 ? make(double{}) : make(float{});
}

/// Moving tissue of elements: tensors, elements that turn, or elements whose strain is averaged.
std::unique_ptr<DynamicModel> make_element_model(const ElasticMesh& mesh, const Dynamic& motion);

}  // namespace palpate
