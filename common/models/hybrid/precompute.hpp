#pragma once
#include "common/archive/archive.hpp"
#include "common/fem/condensation.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/models/hybrid/spec.hpp"

namespace palpate {

/// The whole body's mesh, at a partial connection what the two meshes make together, and which of its tetrahedra move.
struct HybridParts {
  TetMesh mesh;
  std::vector<int> dynamic;
};

/// `coarse`: the mesh of Hybrid::mesh, null without one. Throws std::runtime_error if a region is empty or the meshes
/// do not meet.
HybridParts find_parts(const HybridSpec& body, const TetMesh& mesh, const TetMesh* coarse);

/// The archive of a hybrid body: rest shape, tetrahedra, materials and boundary conditions of the tensor-mass part, and
/// the tensors of the quasi-static part (CondensedTensors). `coarse`: the mesh of Hybrid::mesh, null without one.
/// Throws std::runtime_error on an unfixed body, empty selections, a region that leaves no part, parts that share no
/// node, a quasi-static part that would float, or too little memory.
Archive precompute(const HybridSpec& body, const TetMesh& mesh, const TetMesh* coarse = nullptr,
                   const Progress& progress = {});

}  // namespace palpate
