#include "tools/generate/flips.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include "common/mesh/quality.hpp"

namespace palpate {
namespace {

using Tet = std::array<int, 4>;

/// Two tetrahedra that share a face, and the three that take their place.
struct Flip {
  std::array<int, 2> before;
  std::array<Tet, 3> after;
  Eigen::Vector3d centre;
  double angle;  ///< [rad] smallest one between two faces of the three
};

/// Faces between two tetrahedra: sorted nodes, and (tetrahedron, place of the node that is not on it) twice.
using Faces = std::map<std::array<int, 3>, std::vector<std::array<int, 2>>>;

Faces faces_of(const TetMesh& mesh) {
  Faces faces;
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) {
    for (int f = 0; f < 4; ++f) {
      const Tet& tet = mesh.tetrahedra[t];
      std::array<int, 3> face{tet[(f + 1) % 4], tet[(f + 2) % 4], tet[(f + 3) % 4]};
      std::sort(face.begin(), face.end());
      faces[face].push_back({t, f});
    }
  }
  return faces;
}

/// All flips whose three are positive, best angles first.
std::vector<Flip> possible_flips(const TetMesh& mesh) {
  std::vector<Flip> flips;
  for (const auto& [face, sides] : faces_of(mesh)) {
    if (sides.size() != 2) continue;
    const auto [first, place] = sides[0];
    const Tet& tet = mesh.tetrahedra[first];
    const int apex = mesh.tetrahedra[sides[1][0]][sides[1][1]];
    Flip flip{{first, sides[1][0]}, {}, Eigen::Vector3d::Zero(), std::numbers::pi};
    for (int n : face) flip.centre += mesh.nodes[n] / 3;
    int k = 0;
    bool positive = true;
    for (int corner = 0; corner < 4; ++corner) {
      if (corner == place) continue;
      Tet& turned = flip.after[k++] = tet;  // the apex takes the place of one node of the face
      turned[corner] = apex;
      positive = positive && tet_shape(mesh, turned) > kDegenerateShape;
      if (positive) flip.angle = std::min(flip.angle, min_dihedral_angle(mesh, turned));
    }
    if (positive) flips.push_back(flip);
  }
  std::stable_sort(flips.begin(), flips.end(), [](const Flip& a, const Flip& b) { return a.angle > b.angle + 1e-9; });
  return flips;
}

/// The flip farthest from those taken, of the ones as good as the best to 1 degree that share no tetrahedron
/// with them.
const Flip* next_flip(const std::vector<Flip>& flips, const std::vector<Flip>& taken) {
  const Flip* best = nullptr;
  double farthest = 0, angle = 0;
  for (const Flip& flip : flips) {
    if (best && flip.angle < angle - std::numbers::pi / 180) break;
    double distance = std::numeric_limits<double>::max();
    bool apart = true;
    for (const Flip& other : taken) {
      distance = std::min(distance, (flip.centre - other.centre).norm());
      for (int t : other.before) apart = apart && t != flip.before[0] && t != flip.before[1];
    }
    if (!apart || distance <= farthest * (1 + 1e-9)) continue;
    if (!best) angle = flip.angle;
    best = &flip;
    farthest = distance;
  }
  return best;
}

}  // namespace

void flip_faces(TetMesh& mesh, int count) {
  const std::vector<Flip> flips = possible_flips(mesh);
  std::vector<Flip> taken;
  for (int i = 0; i < count; ++i) {
    const Flip* flip = next_flip(flips, taken);
    if (!flip) throw std::runtime_error("the mesh has no further pair of tetrahedra to flip");
    taken.push_back(*flip);
  }
  for (const Flip& flip : taken) {
    mesh.tetrahedra[flip.before[0]] = flip.after[0];
    mesh.tetrahedra[flip.before[1]] = flip.after[1];
    mesh.tetrahedra.push_back(flip.after[2]);
  }
}

}  // namespace palpate
