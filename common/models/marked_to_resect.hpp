#pragma once
#include "common/models/body.hpp"

namespace palpate {

/// What of a body is to be cut off, as the scene marks it [m]; null where it does not, or the body cannot be cut.
const Box* marked_to_resect(const Body& body);

}  // namespace palpate
