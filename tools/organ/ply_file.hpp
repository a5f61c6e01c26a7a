#pragma once
#include <string_view>

#include "tools/organ/polygons.hpp"

namespace palpate {

/// Reads the vertices and faces of a PLY file, as text or as bytes of either order, with numbers of any of the format's
/// types; what else its elements have is passed over. Throws std::runtime_error(reason) with the line of the header or
/// the element.
Polygons read_ply(std::string_view bytes);

}  // namespace palpate
