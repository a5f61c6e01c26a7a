#pragma once
#include "tools/study/solid_case.hpp"

namespace palpate::study {

/// Where moving tissue comes to rest under a force on the first patch after a slot has been cut beside it,
/// against a fresh solve of what is left (`cut_mesh`); and, in a second row, how wrong tensors are that do
/// not know of the cut. Throws std::runtime_error where no slot can be cut that leaves the body in one piece.
Result rest_after_cut(const SolidCase& solid, const Body& body, Row row);

}  // namespace palpate::study
