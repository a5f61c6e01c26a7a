#include "tools/organ/mesh_pieces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "common/geometry/joined_sets.hpp"
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

/// Two tetrahedra and the face that they share.
struct Neighbours {
  int first, second;
  std::array<int, 3> face;
};

std::vector<Neighbours> neighbours_of(const TetMesh& mesh) {
  std::vector<Neighbours> neighbours;
  const auto faces = faces_of(mesh);
  for (std::size_t f = 1; f < faces.size(); ++f)
    if (faces[f].first == faces[f - 1].first)
      neighbours.push_back({faces[f - 1].second, faces[f].second, faces[f].first});
  return neighbours;
}

double face_area(const TetMesh& mesh, const std::array<int, 3>& face) {
  const Eigen::Vector3d& a = mesh.nodes[face[0]];
  return 0.5 * (mesh.nodes[face[1]] - a).cross(mesh.nodes[face[2]] - a).norm();
}

}  // namespace

std::vector<MeshPiece> pieces_of(const TetMesh& mesh) {
  JoinedSets sets(mesh.tetrahedra.size());
  for (const Neighbours& n : neighbours_of(mesh)) sets.join(n.first, n.second);
  std::vector<MeshPiece> pieces(mesh.tetrahedra.size());
  for (std::size_t t = 0; t < pieces.size(); ++t) {
    MeshPiece& piece = pieces[sets.leader(static_cast<int>(t))];
    piece.place = mesh.nodes[mesh.tetrahedra[t][0]];
    piece.volume += tet_volume(mesh, mesh.tetrahedra[t]);
  }
  std::erase_if(pieces, [](const MeshPiece& piece) { return piece.volume == 0; });
  std::ranges::stable_sort(pieces, std::ranges::greater{}, &MeshPiece::volume);
  return pieces;
}

void give_stray_pieces_away(FilledSolid& filled) {
  constexpr double kStray = 0.01;  // of its part's volume
  std::vector<int>& part = filled.part;
  const std::vector<Neighbours> neighbours = neighbours_of(filled.mesh);
  JoinedSets sets(part.size());
  for (const Neighbours& n : neighbours)
    if (part[n.first] == part[n.second]) sets.join(n.first, n.second);
  std::vector<double> volume(part.size(), 0);  // of each piece, at its leader
  std::map<int, double> whole, largest;        // of each part
  for (std::size_t t = 0; t < part.size(); ++t) {
    double& piece = volume[sets.leader(static_cast<int>(t))];
    piece += tet_volume(filled.mesh, filled.mesh.tetrahedra[t]);
    whole[part[t]] += tet_volume(filled.mesh, filled.mesh.tetrahedra[t]);
    largest[part[t]] = std::max(largest[part[t]], piece);
  }
  std::map<int, std::map<int, double>> shared;  // [m^2] of each stray piece with other parts
  for (const Neighbours& n : neighbours)
    for (const auto& [here, there] : {std::pair{n.first, n.second}, {n.second, n.first}}) {
      const int piece = sets.leader(here), own = part[here];
      const bool is_stray = volume[piece] < largest[own] && volume[piece] < kStray * whole[own];
      if (is_stray && part[there] != own) shared[piece][part[there]] += face_area(filled.mesh, n.face);
    }
  for (std::size_t t = 0; t < part.size(); ++t) {
    const auto stray = shared.find(sets.leader(static_cast<int>(t)));
    if (stray == shared.end()) continue;
    const auto most = std::ranges::max_element(stray->second, {}, [](const auto& other) { return other.second; });
    part[t] = most->first;
  }
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
