#pragma once
#include <memory>

#include "common/dynamics/dynamic_model.hpp"
#include "common/dynamics/elastic_mesh.hpp"

namespace palpate {

/// The integrator that a scene names for a body.
Integrator integrator_of(const Body& body);

/// The moving tissue that a body asks for: tensors, springs or turning elements, in the precision that it names. For
/// a hybrid body `mesh` is its tensor-mass part.
std::unique_ptr<DynamicModel> make_dynamic_model(const ElasticMesh& mesh, const Body& body);

}  // namespace palpate
