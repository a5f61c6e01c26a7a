#pragma once
#include "common/scene/scene.hpp"
#include "common/tensors/archive.hpp"

namespace palpate {

/// The file that holds (or will hold) the archive of a body of a scene; empty for a catheter, which needs none.
std::filesystem::path archive_path(const Scene& scene, const Body& body);

/// Reads the archive of a body for the run time, by the scene alone: no mesh is loaded and nothing is
/// computed. Of a catheter it is made here: a surface, the tube at rest, and nothing else. Throws std::runtime_error
/// with what to do if it is missing or refused.
Archive find_archive(const Scene& scene, const Body& body, ArchivePart part);

}  // namespace palpate
