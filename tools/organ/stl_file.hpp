#pragma once
#include <string_view>

#include "tools/organ/surface_file.hpp"

namespace palpate {

/// Reads the bytes of an STL file, three nodes of its own for each triangle, in the file's unit. What it is, text or
/// binary, is judged by its size and contents. Throws std::runtime_error(reason).
ReadSurface read_stl(std::string_view bytes);

}  // namespace palpate
