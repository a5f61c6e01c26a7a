#pragma once
#include <string>

#include "common/mesh/tet_mesh.hpp"
#include "common/mesh/visual_spec.hpp"
#include "tools/tissue_table.hpp"

namespace palpate {

struct SceneWishes {
  std::string fixed = kHeldBy;  ///< group by which the body is held
  double radius = 0.006;        ///< [m] of the probe's tip
  double press = 0;             ///< [m] that it goes in; 0: a fortieth of the body's diagonal, half the radius at most
  VisualSpec visual;            ///< as the scene names it; no surface: the body's own is drawn
};

/// A scene file and the trajectory that it names.
struct SceneTexts {
  std::string scene, trajectory;
};

/// One body of the mesh, groups of tetrahedra that have a tissue's name being of it; a probe that stands off the side
/// that lies farthest from where the body is held, along the normal there, goes in, slides and comes back; a camera
/// that sees both from the side. `mesh_name`, `trajectory_name`: as the scene names them. Throws
/// std::runtime_error(reason) where the group is not in the mesh or holds all of it.
SceneTexts scene_for(const TetMesh& mesh, const std::string& mesh_name, const std::string& trajectory_name,
                     const Tissue& tissue, const SceneWishes& wishes);

}  // namespace palpate
