#pragma once
#include "common/archive/archive.hpp"
#include "common/archive/archive_place.hpp"
#include "common/scene/scene.hpp"

namespace palpate {

/// The file that holds (or will hold) the archive of a body; empty for one without a mesh, which needs none.
std::filesystem::path archive_path(const Body& body);

/// Reads the archive of a body for the run time, by the scene alone: no mesh is loaded and nothing is
/// computed; that of a body without a mesh is made here. Throws std::runtime_error
/// with what to do if it is missing or refused.
Archive find_archive(const Scene& scene, const Body& body, ArchivePart part);

}  // namespace palpate
