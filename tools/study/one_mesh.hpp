#pragma once
#include <concepts>
#include <optional>

#include "common/mesh/mesh_file.hpp"
#include "common/models/body.hpp"

namespace palpate::study {

/// A solid body on one mesh, and that mesh.
struct OneMesh {
  Body body;
  SolidSpec solid;  ///< what of the body every solid has
  TetMesh mesh;
  bool joined = false;  ///< of two meshes
};

/// None for a body without tetrahedra.
inline std::optional<OneMesh> on_one_mesh(const NamedSpec&) {
  return {};
}
template <std::derived_from<SolidSpec> Spec>
std::optional<OneMesh> on_one_mesh(const Spec& body) {
  return OneMesh{body, body, load_tet_mesh(body.mesh, body.scale)};
}
/// Of a hybrid whose tensor-mass part has a mesh of its own that is a region of both meshes joined, and the second file
/// is no longer named. None where those two meet at some nodes only: a continuum held at points gives way without end
/// as its mesh gets finer, so that nothing converged is there to compare with.
std::optional<OneMesh> on_one_mesh(const HybridSpec& body);
std::optional<OneMesh> on_one_mesh(const Body& body);

}  // namespace palpate::study
