#include "tools/organ/mesh_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"
#include "tools/organ/surface_shells.hpp"

namespace palpate {
namespace {

/// Each face with the tetrahedron it belongs to, those of one face beside one another.
std::vector<std::pair<std::array<int, 3>, int>> faces_of(const TetMesh& mesh) {
  std::vector<std::pair<std::array<int, 3>, int>> faces;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    for (const auto& corners : kTetFaces) {
      std::array<int, 3> face;
      for (int c = 0; c < 3; ++c) face[c] = mesh.tetrahedra[t][corners[c]];
      std::ranges::sort(face);
      faces.emplace_back(face, static_cast<int>(t));
    }
  std::ranges::sort(faces);
  return faces;
}

}  // namespace

std::vector<MeshPiece> pieces_of(const TetMesh& mesh) {
  std::vector<int> leader(mesh.tetrahedra.size());
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int t) {
    while (leader[t] != t) t = leader[t] = leader[leader[t]];
    return t;
  };
  const auto faces = faces_of(mesh);
  for (std::size_t f = 1; f < faces.size(); ++f)
    if (faces[f].first == faces[f - 1].first) {
      const auto [low, high] = std::minmax({find(faces[f].second), find(faces[f - 1].second)});
      leader[high] = low;
    }
  std::vector<MeshPiece> pieces(mesh.tetrahedra.size());
  for (std::size_t t = 0; t < leader.size(); ++t) {
    MeshPiece& piece = pieces[find(static_cast<int>(t))];
    piece.place = mesh.nodes[mesh.tetrahedra[t][0]];
    piece.volume += tet_volume(mesh, mesh.tetrahedra[t]);
  }
  std::erase_if(pieces, [](const MeshPiece& piece) { return piece.volume == 0; });
  std::ranges::stable_sort(pieces, std::ranges::greater{}, &MeshPiece::volume);
  return pieces;
}

Topology topology_of(const TetMesh& mesh) {
  const Surface surface = extract_surface(mesh);
  const auto surfaces = static_cast<int>(shells_of({mesh.nodes, surface.triangles}).size());
  const double euler = static_cast<double>(surface.nodes.size()) - 0.5 * static_cast<double>(surface.triangles.size());
  return {surfaces, static_cast<int>(std::lround(surfaces - 0.5 * euler))};
}

TetMesh part_of(const FilledSolid& filled, int part) {
  TetMesh mesh{filled.mesh.nodes, {}, {}};
  for (std::size_t t = 0; t < filled.part.size(); ++t)
    if (filled.part[t] == part) mesh.tetrahedra.push_back(filled.mesh.tetrahedra[t]);
  return mesh;
}

}  // namespace palpate
