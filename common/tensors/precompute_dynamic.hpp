#pragma once
#include "common/fem/condensation.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/tensors/archive.hpp"

namespace palpate {

/// What every archive begins with: names and materials.
Archive start_archive(const Body& body, const TetMesh& mesh, const MaterialField& materials);

/// The archive of a body that moves with inertia. Tensor-mass and spring-mass bodies: rest shape, tetrahedra,
/// materials and fixation. Hybrid ones: those of the tensor-mass part, and the tensors of the quasi-static
/// part (HybridTensors). `coarse`: the mesh of Hybrid::mesh, null without one. Throws std::runtime_error on
/// an unfixed body, empty selections, a region that leaves no part, parts that share no node, a quasi-static
/// part that would float, or too little memory.
Archive precompute_dynamic(const Body& body, const TetMesh& mesh, const TetMesh* coarse, const Progress& progress = {});

}  // namespace palpate
