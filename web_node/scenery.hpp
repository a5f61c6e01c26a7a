#pragma once
#include <span>
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/scene/scene.hpp"

namespace palpate::web {

/// The message with all that stays the same while a scene runs: camera, colours, rest shapes, instruments, backdrop.
/// `surfaces`: one per body.
std::string scenery_message(const Scene& scene, std::span<const SurfaceMap> surfaces, const TriangleMesh& backdrop);

/// The message with the triangles of all bodies [surface node numbers, outward]. `number` counts them.
std::string topology_message(std::uint32_t number, std::span<const std::vector<std::array<int, 3>>> triangles);

}  // namespace palpate::web
