#include "common/mesh/surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace palpate {
namespace {

struct Face {
  std::array<int, 3> key;  // ascending
  int place;               // 4 * tetrahedron + face
};

std::vector<Face> all_faces(const TetMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(4 * mesh.tetrahedra.size());
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) {
    for (int f = 0; f < 4; ++f) {
      const auto& tet = mesh.tetrahedra[t];
      std::array<int, 3> key{tet[kTetFaces[f][0]], tet[kTetFaces[f][1]], tet[kTetFaces[f][2]]};
      std::sort(key.begin(), key.end());
      faces.push_back({key, 4 * t + f});
    }
  }
  return faces;
}

}  // namespace

Surface extract_surface(const TetMesh& mesh) {
  std::vector<Face> faces = all_faces(mesh);
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.key != b.key ? a.key < b.key : a.place < b.place; });

  std::vector<int> single;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].key == faces[i].key) ++end;
    if (end == i + 1) single.push_back(faces[i].place);
    i = end;
  }
  std::sort(single.begin(), single.end());

  Surface surface;
  surface.triangles.reserve(single.size());
  for (int place : single) {
    const auto& tet = mesh.tetrahedra[place / 4];
    const auto& face = kTetFaces[place % 4];
    surface.triangles.push_back({tet[face[0]], tet[face[1]], tet[face[2]]});
    surface.tetrahedra.push_back(place / 4);
  }
  for (const auto& triangle : surface.triangles) {
    surface.nodes.insert(surface.nodes.end(), triangle.begin(), triangle.end());
  }
  std::sort(surface.nodes.begin(), surface.nodes.end());
  surface.nodes.erase(std::unique(surface.nodes.begin(), surface.nodes.end()), surface.nodes.end());
  return surface;
}

std::vector<double> node_areas(const std::vector<Eigen::Vector3d>& nodes,
                               const std::vector<std::array<int, 3>>& triangles) {
  std::vector<double> area(nodes.size(), 0.0);
  for (const auto& [a, b, c] : triangles) {
    const double whole = (nodes[b] - nodes[a]).cross(nodes[c] - nodes[a]).norm() / 2;
    for (const int n : {a, b, c}) area[n] += whole / 3;
  }
  return area;
}

}  // namespace palpate
