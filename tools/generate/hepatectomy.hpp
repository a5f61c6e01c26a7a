#pragma once
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// The organ of the hepatectomy (RR3510 sec. 7): the shape of the default organ, filled a little finer: about
/// 1,537 nodes and 7,039 tetrahedra. Groups: "attachment" as there, "segment": the tetrahedra at the end of
/// the thin lobe, 18 % of all, and "remnant": the others. Both parts are connected and have a manifold
/// surface.
TetMesh make_hepatectomy();

}  // namespace palpate
