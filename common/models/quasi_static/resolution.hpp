#pragma once
#include "common/fem/offline_spec.hpp"

namespace palpate {

/// [1] Over how many edges of the mesh the elements behind tensors know the body's compliance: nearer by they are too
/// stiff.
inline double edges_resolved(const Offline& offline) {
  return (offline.element == FiniteElement::p2 ? 2.0 : 5.0) / (1 << offline.refine);
}

}  // namespace palpate
