#pragma once
#include "common/archive/archive.hpp"
#include "common/fem/condensation.hpp"
#include "common/mesh/shell_mesh.hpp"
#include "common/scene/scene.hpp"

namespace palpate {

/// What became of a body's archive.
struct ArchiveState {
  std::filesystem::path file;  ///< empty for a body without a mesh, which needs none
  bool up_to_date = false;     ///< nothing had to be computed
  std::string refused;         ///< why the file that was there was rebuilt; empty if there was none or it was good
  double seconds = 0;          ///< from the loaded mesh to the renamed archive
};

/// Sees to it that the archive of a body exists and is whole: reads it, or loads the mesh, computes and
/// writes. Throws std::runtime_error on a bad mesh or body and on a full disk.
ArchiveState ensure_archive(const Scene& scene, const Body& body, const Progress& progress = {});

/// Whether the bodies that are led into a wall of that mesh can be. Throws std::runtime_error("FILE: reason"), FILE
/// being the wall's mesh.
void check_guests(const Scene& scene, const ShellSpec& wall, const ShellMesh& mesh);

/// ensure_archive() for every body, and the parts asked for.
std::vector<Archive> load_or_precompute(const Scene& scene, ArchivePart part, const Progress& progress = {});

}  // namespace palpate
