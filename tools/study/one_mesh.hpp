#pragma once
#include <optional>

#include "common/mesh/tet_mesh.hpp"
#include "common/scene/scene.hpp"

namespace palpate::study {

/// A body on one mesh, and that mesh: of a hybrid whose tensor-mass part has a mesh of its own that is a region of both
/// meshes joined, and the second file is no longer named. None where those two meet at some nodes only: a continuum
/// held at points gives way without end as its mesh gets finer, so that nothing converged is there to compare with.
struct OneMesh {
  Body body;
  TetMesh mesh;
};
std::optional<OneMesh> on_one_mesh(const Body& body);

}  // namespace palpate::study
