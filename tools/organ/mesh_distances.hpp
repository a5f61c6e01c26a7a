#pragma once
#include <string>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "tools/organ/output.hpp"

namespace palpate {

struct NamedMesh {
  std::string name;
  const TetMesh& mesh;  ///< in the frame in which places are told
};

/// Tells how near several meshes come to one another, by nodes of each and triangles of the other; of fewer than two
/// nothing. `gap`: [m] asked for between them, 0: none. With a gap less than half of it is warned of, and
/// std::runtime_error is thrown where two cross; without one that is warned of.
void tell_distances(const std::vector<NamedMesh>& meshes, double gap, Output& out);

}  // namespace palpate
