#pragma once
#include <string>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Names of groups, in their order. A mesh file's groups go by a number, and most by a name too: a number that
/// is another group's is left out.
std::vector<std::string> group_names(const std::map<std::string, MeshGroup>& groups);

}  // namespace palpate
