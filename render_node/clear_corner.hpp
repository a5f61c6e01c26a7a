#pragma once
#include <span>

#include "common/view/draw_list.hpp"

namespace palpate {

/// The corner of a picture of this shape (width by height) in which the instruments' shafts, as they stand, are seen
/// least: the upper left one where others are no better. Throws std::runtime_error if the camera looks nowhere.
Corner clear_corner(const Camera& camera, std::span<const InstrumentView> instruments, double aspect);

}  // namespace palpate
