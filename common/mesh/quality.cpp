#include "common/mesh/quality.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "common/geometry/joined_sets.hpp"
#include "common/mesh/faults.hpp"
#include "common/mesh/surface.hpp"

namespace palpate {
namespace {

void check_numbers_and_coordinates(const TetMesh& mesh, FaultList& faults) {
  const int count = static_cast<int>(mesh.nodes.size());
  std::vector<char> seen(count, 0);
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    for (int n : mesh.tetrahedra[e]) {
      if (n < 0 || n >= count) {
        faults.add(fmt::format("element {}: node {} does not exist, the mesh has {} nodes", e, n, count));
      } else if (!seen[n]) {
        seen[n] = 1;
        if (!mesh.nodes[n].allFinite()) {
          faults.add(fmt::format("element {}: node {} has a coordinate that is not a finite number", e, n));
        }
      }
    }
  }
  for (int n = 0; n < count; ++n) {
    if (!seen[n] && !mesh.nodes[n].allFinite()) {
      faults.add(fmt::format("node {} (in no element) has a coordinate that is not a finite number", n));
    }
  }
}

void check_shapes(const TetMesh& mesh, FaultList& faults) {
  std::map<std::array<int, 4>, std::size_t> first;
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    std::array<int, 4> key = mesh.tetrahedra[e];
    std::sort(key.begin(), key.end());
    const auto twice = std::adjacent_find(key.begin(), key.end());
    if (twice != key.end()) {
      faults.add(fmt::format("element {}: degenerate, it uses node {} twice", e, *twice));
      continue;
    }
    const auto [place, is_new] = first.emplace(key, e);
    if (!is_new) faults.add(fmt::format("element {}: the same tetrahedron as element {}", e, place->second));
    const double shape = tet_shape(mesh, mesh.tetrahedra[e]);
    if (std::abs(shape) < kDegenerateShape) {
      faults.add(
          fmt::format("element {}: degenerate, its four nodes lie in a plane (shape {:.1e}, at least {:.0e} is needed)",
                      e, std::abs(shape), kDegenerateShape));
    } else if (shape < 0) {
      faults.add(fmt::format("element {}: inverted, its volume is negative", e));
    }
  }
}

void check_connection(const TetMesh& mesh, FaultList& faults) {
  JoinedSets sets(mesh.nodes.size());
  for (const auto& t : mesh.tetrahedra) {
    for (int c = 1; c < 4; ++c) sets.join(t[0], t[c]);
  }
  struct Part {
    std::size_t first, size;
  };
  std::map<int, Part> parts;
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    ++parts.emplace(sets.leader(mesh.tetrahedra[e][0]), Part{e, 0}).first->second.size;
  }
  for (const auto& [root, part] : parts) {
    if (part.first == 0) continue;
    faults.add(fmt::format("element {}: disconnected, it and {} further elements share no node with element 0's part",
                           part.first, part.size - 1));
  }
}

void check_faces(const TetMesh& mesh, FaultList& faults) {
  std::map<std::array<int, 3>, int> uses;
  for (std::size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    for (int skip = 0; skip < 4; ++skip) {
      std::array<int, 3> face;
      for (int c = 0, k = 0; c < 4; ++c) {
        if (c != skip) face[k++] = mesh.tetrahedra[e][c];
      }
      std::sort(face.begin(), face.end());
      if (++uses[face] == 3) {
        faults.add(
            fmt::format("element {}: not manifold, its face with the nodes {}, {} and {} belongs to two other elements",
                        e, face[0], face[1], face[2]));
      }
    }
  }
}

void check_boundary_edges(const Surface& surface, FaultList& faults) {
  struct Edge {
    int triangle, uses;
  };
  std::map<std::array<int, 2>, Edge> edges;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const int a = surface.triangles[i][c], b = surface.triangles[i][(c + 1) % 3];
      ++edges.emplace(std::array{std::min(a, b), std::max(a, b)}, Edge{static_cast<int>(i), 0}).first->second.uses;
    }
  }
  for (const auto& [nodes, edge] : edges) {
    if (edge.uses == 2) continue;
    faults.add(fmt::format("element {}: not manifold, {} surface triangles meet at the edge between nodes {} and {}",
                           surface.tetrahedra[edge.triangle], edge.uses, nodes[0], nodes[1]));
  }
}

// Corners of triangles around one vertex hang together where their triangles share an edge at that vertex.
void check_boundary_vertices(const Surface& surface, FaultList& faults) {
  const auto& triangles = surface.triangles;
  JoinedSets corners(3 * triangles.size());
  std::map<std::array<int, 2>, int> first_corner;  // (vertex, other end of the edge)
  for (int corner = 0; corner < static_cast<int>(3 * triangles.size()); ++corner) {
    const auto& t = triangles[corner / 3];
    for (int step : {1, 2}) {
      const auto [place, is_new] = first_corner.emplace(std::array{t[corner % 3], t[(corner + step) % 3]}, corner);
      if (!is_new) corners.join(place->second, corner);
    }
  }
  std::map<int, int> fan_of_vertex;
  for (int corner = 0; corner < static_cast<int>(3 * triangles.size()); ++corner) {
    const int vertex = triangles[corner / 3][corner % 3], fan = corners.leader(corner);
    if (fan == corner && !fan_of_vertex.emplace(vertex, fan).second) {
      faults.add(fmt::format("element {}: not manifold, two parts of the surface meet only in node {}",
                             surface.tetrahedra[corner / 3], vertex));
    }
  }
}

}  // namespace

double tet_volume(const TetMesh& mesh, const std::array<int, 4>& t) {
  const Eigen::Vector3d& o = mesh.nodes[t[0]];
  return (mesh.nodes[t[1]] - o).cross(mesh.nodes[t[2]] - o).dot(mesh.nodes[t[3]] - o) / 6;
}

double tet_shape(const TetMesh& mesh, const std::array<int, 4>& t) {
  double sum = 0;
  for (int a = 0; a < 4; ++a) {
    for (int b = a + 1; b < 4; ++b) sum += (mesh.nodes[t[a]] - mesh.nodes[t[b]]).squaredNorm();
  }
  const double length = std::sqrt(sum / 6);
  return length > 0 ? 6 * std::numbers::sqrt2 * tet_volume(mesh, t) / (length * length * length) : 0;
}

double min_dihedral_angle(const TetMesh& mesh, const std::array<int, 4>& t) {
  std::array<Eigen::Vector3d, 4> normal;  // of the face opposite to vertex i, all to one side
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d &a = mesh.nodes[t[(i + 1) % 4]], &b = mesh.nodes[t[(i + 2) % 4]],
                          &c = mesh.nodes[t[(i + 3) % 4]];
    normal[i] = (b - a).cross(c - a).normalized();
    if (normal[i].dot(mesh.nodes[t[i]] - a) > 0) normal[i] = -normal[i];
  }
  double smallest = std::numbers::pi;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      smallest = std::min(smallest, std::acos(std::clamp(-normal[i].dot(normal[j]), -1.0, 1.0)));
    }
  }
  return smallest;
}

void check_tet_mesh(const TetMesh& mesh, const std::string& where) {
  if (mesh.tetrahedra.empty()) throw std::runtime_error(where + ": the mesh has no tetrahedra");
  FaultList faults;
  check_numbers_and_coordinates(mesh, faults);
  faults.raise(where);

  check_shapes(mesh, faults);
  faults.raise(where);

  check_connection(mesh, faults);
  check_faces(mesh, faults);
  const Surface surface = extract_surface(mesh);
  check_boundary_edges(surface, faults);
  check_boundary_vertices(surface, faults);
  faults.raise(where);
}

}  // namespace palpate
