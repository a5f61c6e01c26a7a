#include "common/models/quasi_static/spec.hpp"

namespace palpate {

Offline offline_of(const QuasiStaticSpec& body, int surface_nodes) {
  return body.offline.value_or(Offline{.element = surface_nodes > kMostQuadratic ? "p1" : "p2"});
}

}  // namespace palpate
