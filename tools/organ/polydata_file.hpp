#pragma once
#include <string_view>

#include "tools/organ/polygons.hpp"

namespace palpate {

/// Whether a legacy VTK file holds a surface, DATASET POLYDATA.
bool is_polydata(std::string_view bytes);

/// Its points, polygons and strips of triangles, as text or binary. Throws std::runtime_error(reason).
Polygons read_polydata(std::string_view bytes);

}  // namespace palpate
