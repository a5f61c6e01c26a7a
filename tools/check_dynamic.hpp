#pragma once
#include <vector>

#include "common/archive/archive.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/scene/scene.hpp"
#include "tools/footprint.hpp"

namespace palpate {

/// The archive of a dynamic body: the one on disk if it is good, else computed here and not written. Throws
/// std::runtime_error on a body that cannot be computed with.
Archive dynamic_archive(const Scene& scene, const Body& body, const TetMesh& mesh);

/// Prints the moving part, its model, step, tearing and connection. Throws std::runtime_error if the scene
/// gives a step that is not stable.
void print_dynamic(const Body& body, const TetMesh& mesh, const Archive& archive);

/// What a dynamic body takes; the deformation node's parts are built here and measured.
std::vector<MemoryPart> dynamic_memory(const Scene& scene, const Body& body, const Archive& archive);

/// What tools and dynamic bodies do not give each other: a pedal that is never down, jaws that never close,
/// nothing to cut.
std::vector<std::string> cutting_warnings(const Scene& scene);

}  // namespace palpate
