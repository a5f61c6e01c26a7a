#pragma once
#include <string>
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "common/scene/scene.hpp"

namespace palpate {

/// Prints what the tensors of a body come from where that is not its mesh itself, and refuses a section that cannot
/// be served. Throws std::runtime_error.
void print_offline(const QuasiStaticSpec& body, const TetMesh& mesh);

/// One sentence where a body's Poisson's ratio makes its linear elements lock, with the cure.
std::vector<std::string> locking_warnings(const Body& body);

}  // namespace palpate
