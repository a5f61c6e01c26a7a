#include "tools/organ/angles_around.hpp"

#include <algorithm>
#include <numbers>

#include "common/mesh/quality.hpp"

namespace palpate {

AnglesAround::AnglesAround(const TetMesh& mesh) : mesh_(mesh), around_(mesh.nodes.size()) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (const int n : mesh.tetrahedra[t]) around_[n].push_back(static_cast<int>(t));
}

double AnglesAround::least(int node) const {
  double angle = std::numbers::pi;
  for (const int t : around_[node]) {
    const auto& nodes = mesh_.tetrahedra[t];
    angle = std::min(angle, tet_volume(mesh_, nodes) > 0 ? min_dihedral_angle(mesh_, nodes) : 0);
  }
  return angle * 180 / std::numbers::pi;
}

}  // namespace palpate
