#pragma once
#include "common/archive/archive.hpp"
#include "common/fem/condensation.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Geometry and numbering of a body's visible surface, and of the inner ones among the mesh nodes `also` behind it.
/// Throws std::runtime_error if no node is touchable.
SurfaceMap make_surface_map(const SolidSpec& body, const TetMesh& mesh, const DofMap& dofs,
                            const std::vector<int>& also = {});

/// The free dofs of surface nodes begin .. end - 1, ascending.
std::vector<Dof> free_dofs(const SurfaceMap& surface, int begin, int end);

/// What every archive begins with: names and materials. `kind`: of tissue.
Archive start_archive(const SolidSpec& body, std::string_view kind, const TetMesh& mesh,
                      const MaterialField& materials);

}  // namespace palpate
