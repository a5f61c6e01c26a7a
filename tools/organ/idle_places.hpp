#pragma once
#include "tools/organ/fineness_options.hpp"

namespace palpate {

/// A mesh [m] that was made, and the mean edge of its surface [m].
struct MeshWithEdge {
  const TetMesh& mesh;
  double mean_edge;
};

/// Warns of each --fine that makes nothing finer in any of the meshes made: of one that reaches no part of them, and of
/// one whose edges are no shorter than those asked for there without it.
void warn_of_idle_places(const MeshOptions& options, const std::vector<MeshWithEdge>& made, Output& out);

}  // namespace palpate
