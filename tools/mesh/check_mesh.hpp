#pragma once
#include <filesystem>

#include "tools/shared/check_output.hpp"

namespace palpate {

/// Whether a file's name is that of a mesh or a surface, and not of a scene.
bool names_mesh(const std::filesystem::path& file);
/// Likewise that of a volume of voxels.
bool names_image(const std::filesystem::path& file);

/// Says what a mesh of tetrahedra in metres is, and what its tensors as a quasi-static body would take: all of its
/// surface is touched by one tool, and nothing is held. Throws std::runtime_error on what is no mesh to compute with.
void check_mesh(const std::filesystem::path& file, CheckOutput& out);

}  // namespace palpate
