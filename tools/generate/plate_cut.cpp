#include "tools/generate/plate_cut.hpp"

#include <cmath>

#include "common/mesh/generators.hpp"
#include "tools/generate/flips.hpp"

namespace palpate {

TetMesh make_plate_cut() {
  constexpr double kX = 0.025, kY = 0.055, kThickness = 0.01, kCell = 0.005;  // [m]
  TetMesh mesh = make_block_of_five({-kX, -kY, 0}, {kX, kY, kThickness}, {10, 22, 2});
  mesh.groups.clear();
  for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
    const Eigen::Vector3d& x = mesh.nodes[n];
    const bool at_corner = std::abs(x.x()) > kX - 1.5 * kCell && std::abs(x.y()) > kY - 1.5 * kCell;
    if (at_corner) mesh.groups["corners"].nodes.push_back(n);
  }
  flip_faces(mesh, 12);
  return mesh;
}

}  // namespace palpate
