#pragma once
#include <string_view>

#include "tools/organ/polygons.hpp"

namespace palpate {

/// Reads the vertices and faces of an OFF file as text, also of COFF, NOFF and STOFF, whose colours and the like are
/// passed over. Throws std::runtime_error("line 3: reason").
Polygons read_off(std::string_view bytes);

}  // namespace palpate
