#pragma once
#include <filesystem>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "tools/organ/finding.hpp"

namespace palpate {

/// A surface as its file has it, not yet checked.
struct ReadSurface {
  TriangleMesh mesh;              ///< [m]
  std::vector<Finding> findings;  ///< what the file says of itself that is not so
};

/// Reads STL (text or binary, whatever its first line or its count say), OBJ, PLY, OFF, legacy VTK and VTP. Polygons
/// are cut into triangles. `scale` [m per unit of the file].
/// Throws std::runtime_error("FILE: reason") where it is none of these, holds no triangle or a number that is none, or
/// is of no body's size (surface_extent.hpp).
ReadSurface read_surface(const std::filesystem::path& file, double scale);

}  // namespace palpate
