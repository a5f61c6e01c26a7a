#pragma once
#include <concepts>

#include "common/dynamics/make_model.hpp"
#include "common/models/body.hpp"
#include "common/models/hybrid/precompute.hpp"
#include "common/models/moving/precompute.hpp"

/// Solids of a scene on a mesh that is at hand, and as another kind of tissue.
namespace palpate {

/// The solid as another kind; what that kind alone has is as by default.
template <std::derived_from<SolidSpec> Spec>
Spec as_kind(const SolidSpec& solid) {
  Spec spec;
  static_cast<SolidSpec&>(spec) = solid;
  return spec;
}

inline Dynamic& motion_of(Body& body) {
  return as<MovingSpec>(body)->dynamic;
}
inline const Dynamic& motion_of(const Body& body) {
  return as<MovingSpec>(body)->dynamic;
}

inline MakeDynamicModel model_maker(const Body& body) {
  return as<SpringMassSpec>(body) ? make_spring_model : make_element_model;
}

/// The archive of moving tissue of any kind, a hybrid's parts being of one mesh. Throws as the kind's own does.
inline Archive precompute_tissue(const Body& body, const TetMesh& mesh) {
  if (const auto* hybrid = as<HybridSpec>(body)) return precompute(*hybrid, mesh);
  return precompute_moving(*as<MovingSpec>(body), kind_of(body), mesh);
}

}  // namespace palpate
