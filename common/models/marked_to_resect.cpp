#include "common/models/marked_to_resect.hpp"

namespace palpate {

const Box* marked_to_resect(const Body& body) {
  const auto* moving = as<MovingSpec>(body);
  return moving && moving->dynamic.resect ? &*moving->dynamic.resect : nullptr;
}

}  // namespace palpate
