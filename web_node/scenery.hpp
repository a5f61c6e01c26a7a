#pragma once
#include <span>
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/scene/scene.hpp"
#include "common/view/visual_body.hpp"

namespace palpate::web {

/// The message with all that stays the same while a scene runs: camera, colours, rest shapes, instruments, backdrop.
/// `surfaces` and `visuals`: one per body. Places are counted from `origin` [m] on, those of the visuals already.
std::string scenery_message(const Scene& scene, std::span<const SurfaceMap> surfaces, const TriangleMesh& backdrop,
                            std::span<const std::optional<VisualBody>> visuals, const Eigen::Vector3d& origin);

/// What is to be seen of a body's topology.
struct BodyTopology {
  std::vector<std::array<int, 3>> triangles;  ///< of its own surface: surface node numbers, outward
  std::vector<int> pieces;  ///< per tetrahedron, for a visual surface after a cut, as VisualShape::part() takes it
};

/// The message with that of all bodies. `number` counts them.
std::string topology_message(std::uint32_t number, std::span<const BodyTopology> bodies);

}  // namespace palpate::web
