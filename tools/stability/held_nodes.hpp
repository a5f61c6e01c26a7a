#pragma once
#include "common/archive/archive.hpp"
#include "tools/stability/case.hpp"

namespace palpate::stability {

/// Holds `count` free touchable nodes of a quasi-static body at once and moves them by `press` [m] towards the middle
/// of its surface. `how`: spread (over all of them), collinear (nine in a row of the numbering, over and over),
/// coincident (one node), adjacent (the same, a billionth of an edge apart), contradictory (the same, every second one
/// outward). Throws std::runtime_error where the body has fewer nodes or the haptic step holds no more than `most`.
Result hold_nodes(const Archive& archive, const std::string& how, int count, double press, int most);

}  // namespace palpate::stability
