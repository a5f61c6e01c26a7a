#pragma once
#include <concepts>
#include <memory>
#include <string>

#include "tools/rig/kinds.hpp"
#include "tools/study/method.hpp"
#include "tools/study/solid_case.hpp"

namespace palpate::study {

// Springs turn with the tissue by themselves and have no strain; a hybrid is neither cut nor refined.
constexpr bool has_elements(const MovingSpec&) {
  return true;
}
constexpr bool has_elements(const SpringMassSpec&) {
  return false;
}
constexpr bool can_be_cut(const MovingSpec&) {
  return true;
}
constexpr bool can_be_cut(const HybridSpec&) {
  return false;
}

/// A model of moving tissue, for a body that may be of another kind.
struct MovingModel {
  std::string name;  ///< as a scene file has it
  bool own;          ///< the body is of that kind in its scene
  bool elements;     ///< it has some, which can turn with the tissue, or average their strain
  bool cut;          ///< it is cut and refined
  void (*become)(Body& body);
};
/// The model Spec for a body of the kind Own.
template <std::derived_from<MovingSpec> Spec, std::derived_from<SolidSpec> Own>
MovingModel moving_model() {
  constexpr bool own = std::same_as<Spec, Own>;
  const Spec spec;
  return {std::string(Spec::kKind), own, has_elements(spec), own && can_be_cut(spec),
          [](Body& body) { body = as_kind<Spec>(body); }};
}

/// Moving tissue of one model pressed in the deformation node's organ: element, integrator, step, precision,
/// resolution, share of a hybrid's dynamic elements; rest after a cut. A body that has another model in its scene is
/// neither cut nor refined, and in quick mode gets the model alone, and each element.
std::unique_ptr<Method> make_dynamic(std::shared_ptr<SolidCase> solid, const MovingModel& model);

/// A body on a finer mesh of the same shape, everything that names its nodes and elements named anew.
struct FinerBody {
  Body body;
  TetMesh mesh;
};
FinerBody finer_body(const Body& body, const StaticProblem& problem, double share_of_edge);

}  // namespace palpate::study
