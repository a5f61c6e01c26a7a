#pragma once
#include <filesystem>

#include "common/mesh/tet_mesh.hpp"
#include "common/mesh/visual_spec.hpp"

namespace palpate {

/// A surface to be looked at, of millimetres or metres, whichever lies about a mesh. Of an OBJ: colours from an MTL of
/// its name where there is one, and the image that is named there (map_Kd), as a PNG where that says or beside the OBJ;
/// without an MTL a PNG of the OBJ's name, where it has texture coordinates. Throws std::runtime_error("FILE: ...").
VisualSpec visual_about(const TetMesh& mesh, const std::filesystem::path& surface);

}  // namespace palpate
