#pragma once
#include "tools/organ/fineness_options.hpp"

namespace palpate {

/// Warns of each --fine that makes nothing finer: of one that reaches no part of a mesh [m], and of one whose edges are
/// no shorter than those asked for there without it; `mean_edge` [m] is that of its surface.
void warn_of_idle_places(const MeshOptions& options, const TetMesh& mesh, double mean_edge, Output& out);

}  // namespace palpate
