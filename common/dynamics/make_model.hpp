#pragma once
#include <memory>

#include "common/dynamics/dynamic_model.hpp"
#include "common/dynamics/elastic_mesh.hpp"
#include "common/dynamics/spec.hpp"

namespace palpate {

Integrator integrator_of(const Dynamic& motion);

/// Moving tissue of elements: tensors, or elements that turn, in the precision that is asked for.
std::unique_ptr<DynamicModel> make_element_model(const ElasticMesh& mesh, const Dynamic& motion);

/// Moving tissue of springs along the edges.
std::unique_ptr<DynamicModel> make_spring_model(const ElasticMesh& mesh, const Dynamic& motion);

/// One of these.
using MakeDynamicModel = std::unique_ptr<DynamicModel> (*)(const ElasticMesh& mesh, const Dynamic& motion);

}  // namespace palpate
