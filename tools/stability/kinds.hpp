#pragma once
#include <functional>
#include <vector>

#include "common/models/body.hpp"

/// What the cases of a scene do with each kind of tissue: functions of its spec; see tools/rig/kinds.hpp.
namespace palpate::stability {

/// Every material of the body, its regions' included.
template <class Spec>
std::vector<Material*> materials_in(Spec& body) {
  return {&body.material};
}
template <std::derived_from<SolidSpec> Spec>
std::vector<Material*> materials_in(Spec& body) {
  std::vector<Material*> all{&body.material};
  for (MaterialRegion& region : body.materials) all.push_back(&region.material);
  return all;
}

/// Whether the haptic step can hold the body's nodes by its tensors, at rest.
inline bool holds_nodes(const NamedSpec&) {
  return false;
}
inline bool holds_nodes(const QuasiStaticSpec&) {
  return true;
}

}  // namespace palpate::stability
