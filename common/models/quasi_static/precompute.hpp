#pragma once
#include "common/archive/archive.hpp"
#include "common/fem/condensation.hpp"
#include "common/fem/static_loads.hpp"
#include "common/mesh/tet_mesh.hpp"
#include "common/models/quasi_static/spec.hpp"

namespace palpate {

/// What precompute() did.
struct PrecomputeCost {
  double flops = 0;
  bool condensed = false;  ///< see SurfaceCompliance
};

/// The archive of a quasi-static body on one mesh, the compliance of its surface: assembly, elimination of fixed dofs,
/// one sparse factorisation, dense inverse or block solves (TVCG99 sec. 4-1, by elimination where the paper iterates);
/// with a [body.offline] that asks for more than linear elements on the mesh, that of the finer discretisation between
/// weighted mean displacements (FineProblem), whatever the route. Compressed ones come from block solves; without a
/// `form` form_of() says which it is. `specimen`: the mesh of MeasuredLaw::specimen_mesh, null without one. Where the
/// body asks for presses, they are computed too. The content hash is left empty: it belongs to the files the body
/// names, see ensure_archive(). Throws std::runtime_error on an unfixed body, empty selections, or too little memory.
Archive precompute(const QuasiStaticSpec& body, const TetMesh& mesh, const TetMesh* specimen = nullptr,
                   const Progress& progress = {}, Route route = Route::fastest, PrecomputeCost* cost = nullptr,
                   std::optional<TensorForm> form = {});

/// The body with its offline_of(), on a mesh.
QuasiStaticSpec with_offline(QuasiStaticSpec body, const TetMesh& mesh);

/// Its loads and its weight, under which its shape rests. Throws std::runtime_error as body_loads() does.
StaticLoads resting_loads(const QuasiStaticSpec& body, const TetMesh& mesh);

/// The mesh of MeasuredLaw::specimen_mesh; empty without one.
std::optional<TetMesh> load_specimen(const QuasiStaticSpec& body);

}  // namespace palpate
