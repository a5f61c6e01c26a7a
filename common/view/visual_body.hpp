#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/mesh/visual_binding.hpp"
#include "common/mesh/visual_mesh.hpp"
#include "common/models/body.hpp"
#include "common/view/draw_list.hpp"

namespace palpate {

/// What is drawn in place of a body's own surface.
struct VisualBody {
  VisualMesh mesh;
  VisualBinding binding;  ///< to what is known of the body while it moves: the nodes of its archive
  std::string texture;    ///< PNG; empty: none
};

/// Empty where the body's own surface is drawn. Places are counted from `origin` [m] on. Throws std::runtime_error as
/// load_visual_mesh() and read_png_bytes().
std::optional<VisualBody> load_visual(const Body& body, const Archive& archive, const Eigen::Vector3d& origin);

/// One per body.
std::vector<std::optional<VisualBody>> load_visuals(const Scene& scene, std::span<const Archive> archives,
                                                    const Eigen::Vector3d& origin);

/// How a part is drawn; `tissue`: linear RGB of a part that has no colour of its own.
struct PartLook {
  Finish finish;
  std::array<double, 3> colour;
};
PartLook look_of(const VisualMesh::Part& part, const std::array<double, 3>& tissue);

/// What of a body's own surface is seen below its visual one: what cuts have laid bare, and the triangles about that,
/// where the visual surface ends ragged. `whole` and `now`: the surface before any cut, and as it is.
std::vector<std::array<int, 3>> bared(std::span<const std::array<int, 3>> whole,
                                      std::span<const std::array<int, 3>> now);

}  // namespace palpate
