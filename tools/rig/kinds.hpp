#pragma once
#include <concepts>
#include <stdexcept>

#include "common/models/body.hpp"
#include "common/models/hybrid/precompute.hpp"
#include "common/models/moving/precompute.hpp"
#include "common/models/quasi_static/precompute.hpp"

/// What studies and stability cases ask of every kind of tissue: functions of its spec, as those of
/// common/models/kind.hpp; a function of a base serves the kinds that derive from it. Of a Body it is the kind's own.
namespace palpate {

// What two kinds have in common is what the nearer of their bases holds.
inline void take_over(NamedSpec& to, const NamedSpec& from) {
  to = from;
}
inline void take_over(MeshedSpec& to, const MeshedSpec& from) {
  to = from;
}
inline void take_over(SolidSpec& to, const SolidSpec& from) {
  to = from;
}
inline void take_over(MovingSpec& to, const MovingSpec& from) {
  to = from;
}
// Springs are no elements.
inline void take_over(SpringMassSpec& to, const MovingSpec& from) {
  static_cast<MovingSpec&>(to) = from;
  to.dynamic.element = TetElement::linear;
  to.dynamic.corotational = false;
}
template <std::derived_from<NamedSpec> Spec>
void take_over(Spec& to, const Spec& from) {
  to = from;
}

/// The body as another kind: with all that both have in common, the rest as by default.
template <class Spec, std::derived_from<NamedSpec> From>
Spec as_kind(const From& body) {
  Spec spec;
  take_over(spec, body);
  return spec;
}
template <class Spec>
Spec as_kind(const Body& body) {
  return std::visit([](const auto& from) { return as_kind<Spec>(from); }, body);
}

/// How the body moves; null for one without inertia of its own.
inline Dynamic* motion_in(NamedSpec&) {
  return nullptr;
}
inline Dynamic* motion_in(MovingSpec& body) {
  return &body.dynamic;
}
inline Dynamic* find_motion(Body& body) {
  return std::visit([](auto& spec) { return motion_in(spec); }, body);
}
inline const Dynamic* find_motion(const Body& body) {
  return find_motion(const_cast<Body&>(body));
}
/// Of a body that moves.
inline Dynamic& motion_of(Body& body) {
  return *find_motion(body);
}
inline const Dynamic& motion_of(const Body& body) {
  return *find_motion(body);
}

/// The model of moving tissue on a mesh; null for a body that does not move.
inline std::unique_ptr<DynamicModel> make_model(const NamedSpec&, const ElasticMesh&) {
  return nullptr;
}
inline std::unique_ptr<DynamicModel> make_model(const Body& body, const ElasticMesh& mesh) {
  return std::visit([&](const auto& spec) { return make_model(spec, mesh); }, body);
}

/// The archive of a body on a mesh of tetrahedra that is at hand, a hybrid's parts being of one mesh. Throws as the
/// kind's own does, and std::logic_error for a body without tetrahedra.
inline Archive archive_on(const NamedSpec& body, const TetMesh&) {
  throw std::logic_error("body '" + body.name + "' has no tetrahedra");
}
inline Archive archive_on(const QuasiStaticSpec& body, const TetMesh& mesh) {
  return precompute(body, mesh);
}
inline Archive archive_on(const HybridSpec& body, const TetMesh& mesh) {
  return precompute(body, mesh);
}
template <std::derived_from<MovingSpec> Spec>
Archive archive_on(const Spec& body, const TetMesh& mesh) {
  return precompute_moving(body, Spec::kKind, mesh);
}
inline Archive precompute_on(const Body& body, const TetMesh& mesh) {
  return std::visit([&](const auto& spec) { return archive_on(spec, mesh); }, body);
}

}  // namespace palpate
