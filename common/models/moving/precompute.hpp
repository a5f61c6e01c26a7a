#pragma once
#include <string_view>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/dynamics/spec.hpp"
#include "common/fem/boundary_conditions.hpp"
#include "common/fem/condensation.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/models/kind.hpp"

namespace palpate {

/// The materials of some of the mesh's tetrahedra, in their order.
MaterialField materials_of(const MaterialField& whole, const std::vector<int>& elements);

/// Of the tetrahedra `moving` the body's own element, of all others the linear one.
MaterialField with_elements(const MovingSpec& body, const std::vector<int>& moving, const TetMesh& mesh,
                            MaterialField materials);

/// Fills in the surface map, the tetrahedra and the densities, for the tetrahedra `elements` that move with
/// inertia. Returns the archive's node per mesh node.
std::vector<int> add_moving_part(const SolidSpec& body, const TetMesh& mesh, const DofMap& dofs,
                                 const MaterialField& materials, const std::vector<int>& elements, Archive& archive);

/// Fills in the compliance of the whole body at rest among its touchable nodes: what the patches of tips meet.
void add_compliance_at_rest(const TetMesh& mesh, const DofMap& dofs, const MaterialField& materials,
                            const Progress& progress, Archive& archive);

/// The archive of a body of the kind `kind` that moves with inertia as a whole: rest shape, tetrahedra, materials and
/// boundary conditions. Throws std::runtime_error on an unfixed body, empty selections, or too little memory.
Archive precompute_moving(const MovingSpec& body, std::string_view kind, const TetMesh& mesh,
                          const Progress& progress = {});

}  // namespace palpate
