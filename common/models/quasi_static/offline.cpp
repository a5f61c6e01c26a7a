#include <fmt/format.h>

#include "common/models/quasi_static/spec.hpp"

namespace palpate {
namespace {

bool takes_minutes_with_quadratic(int surface_nodes) {
  return surface_nodes > kMaxQuadratic;
}

}  // namespace

Offline offline_of(const QuasiStaticSpec& body, int surface_nodes) {
  return body.offline.value_or(
      Offline{.element = takes_minutes_with_quadratic(surface_nodes) ? FiniteElement::p1 : FiniteElement::p2});
}

std::string why_offline(const QuasiStaticSpec& body, int surface_nodes) {
  if (body.offline) return {};
  if (takes_minutes_with_quadratic(surface_nodes))
    return fmt::format("the mesh has more than {} surface nodes", kMaxQuadratic);
  return "since linear ones bend too stiffly";
}

}  // namespace palpate
