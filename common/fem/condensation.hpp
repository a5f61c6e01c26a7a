#pragma once
#include <functional>
#include <string_view>
#include <vector>

#include "common/fem/assembly.hpp"
#include "common/fem/progress.hpp"

namespace palpate {

/// The part of K^-1 that the visible surface sees.
struct SurfaceCompliance {
  std::vector<double> touchable;  ///< C_tt [m/N], packed lower triangle by rows
  std::vector<double> other;      ///< C_ot [m/N], row-major: other dofs x touchable dofs
  double flops = 0;               ///< floating-point operations of the route taken
  bool condensed = false;         ///< true: dense Schur complement; false: blocks of right-hand sides
};

enum class Route { fastest, condense, solve };

/// Compliance between the free dofs of the touchable nodes, and of the other visible nodes against them (both
/// lists of mesh nodes, in the order of the result).
///
/// Condensing: the interior is eliminated first and the surface last, so that the trailing block of the one
/// sparse factor K = L L^T is the Cholesky factor of the surface's Schur complement S. With S^-1 = C,
///   C_tt = (L_tt L_tt^T)^-1,   C_ot = -L_oo^-T L_to^T C_tt.
/// Solving: one sparse factor in a fill-reducing order, blocks of unit right-hand sides; cheaper when few of
/// the surface's nodes are touchable. `fastest` compares the operation counts of the two.
SurfaceCompliance surface_compliance(const TetMesh& mesh, const MaterialField& materials, const DofMap& dofs,
                                     const std::vector<int>& touchable, const std::vector<int>& other,
                                     const Progress& progress = {}, Route route = Route::fastest);

}  // namespace palpate
