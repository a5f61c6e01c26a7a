#pragma once
#include <string_view>

#include "tools/organ/polygons.hpp"

namespace palpate {

/// Reads the points, polygons and strips of a VTP file (VTK's XML PolyData, serial): numbers as text, as base64 or
/// appended, as they are or compressed by zlib, of either byte order. Throws std::runtime_error(reason).
Polygons read_vtp(std::string_view text);

}  // namespace palpate
