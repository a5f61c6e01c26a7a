#include "tools/generate/plate.hpp"

#include <cmath>

#include "common/mesh/generators.hpp"

namespace palpate {

TetMesh make_plate(int cells) {
  constexpr double kHalf = 0.05, kThickness = 0.008;
  TetMesh mesh = make_block({-kHalf, -kHalf, 0}, {kHalf, kHalf, kThickness}, {cells, cells, 2});
  const double inner = kHalf - 2.5 * (2 * kHalf / cells);
  for (int n = 0; n < static_cast<int>(mesh.nodes.size()); ++n) {
    const bool at_corner = std::abs(mesh.nodes[n].x()) > inner && std::abs(mesh.nodes[n].y()) > inner;
    if (at_corner) mesh.groups["corners"].nodes.push_back(n);
  }
  return mesh;
}

}  // namespace palpate
