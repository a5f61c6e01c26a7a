#include "tools/organ/part_volumes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/mesh/normals.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/surface.hpp"
#include "tools/organ/mesh_pieces.hpp"

namespace palpate {
namespace {

constexpr double kSameVolume = 1e-4;
constexpr int kSteps = 8;
constexpr double kWithin = 0.2;  // of its border: a part with less of the outer surface lies within others

/// Triangles whose nodes are moved, and for the volume of which part each is.
struct Border {
  Surface surface;
  std::vector<int> part;  ///< from 0
};

double area_of(const TetMesh& mesh, const std::array<int, 3>& t) {
  return 0.5 * (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]]).norm();
}

using Room = std::function<double(const Eigen::Vector3d&)>;

/// [m] That each node of a border may be moved outward; 0: it stays.
std::vector<double> rooms_of(const Border& border, const Room& room, const TetMesh& mesh) {
  std::vector<double> rooms(mesh.nodes.size(), std::numeric_limits<double>::infinity());
  for (const int n : border.surface.nodes)
    if (room) rooms[n] = room(mesh.nodes[n]);
  return rooms;
}

/// `missing`: [m^3] of each part.
void move(const Border& border, const std::vector<double>& missing, const Room& room, TetMesh& mesh) {
  const auto& triangles = border.surface.triangles;
  const std::vector<double> rooms = rooms_of(border, room, mesh);
  std::vector<Eigen::Vector3d> normals(mesh.nodes.size());
  vertex_normals(mesh.nodes, triangles, normals);
  std::vector<double> squares(missing.size(), 0), of_node(mesh.nodes.size(), 0), share(mesh.nodes.size(), 0), area;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto moved = std::ranges::count_if(triangles[i], [&](int n) { return rooms[n] > 0; });
    area.push_back(area_of(mesh, triangles[i]));
    squares[border.part[i]] += area[i] * area[i] * static_cast<double>(moved) / 3;
  }
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const int n : triangles[i]) {
      const int part = border.part[i];
      share[n] += 1;
      if (rooms[n] > 0) of_node[n] += missing[part] / squares[part] * area[i];
    }
  for (const int n : border.surface.nodes) mesh.nodes[n] += std::min(of_node[n] / share[n], rooms[n]) * normals[n];
}

/// What is moved for which part.
struct Borders {
  Border outer;
  std::vector<Border> within;     ///< of parts that lie within others, each its own
  std::vector<char> lies_within;  ///< of each part
};

Borders borders_of(const FilledSolid& filled, std::size_t parts) {
  Borders borders{{extract_surface(filled.mesh), {}}, {}, std::vector<char>(parts, 0)};
  std::vector<double> outside(parts, 0);
  for (std::size_t i = 0; i < borders.outer.surface.triangles.size(); ++i) {
    const int part = filled.part[borders.outer.surface.tetrahedra[i]] - 1;
    borders.outer.part.push_back(part);
    outside[part] += area_of(filled.mesh, borders.outer.surface.triangles[i]);
  }
  for (int p = 0; parts > 1 && p < static_cast<int>(parts); ++p) {
    Border own{extract_surface(part_of(filled, p + 1)), {}};
    double whole = 0;
    for (const auto& t : own.surface.triangles) whole += area_of(filled.mesh, t);
    borders.lies_within[p] = outside[p] < kWithin * whole;
    if (!borders.lies_within[p]) continue;
    own.part.assign(own.surface.triangles.size(), p);
    borders.within.push_back(std::move(own));
  }
  return borders;
}

std::vector<double> missing_of(const std::vector<double>& volumes, const FilledSolid& filled) {
  std::vector<double> missing = volumes_of(filled, volumes.size());
  for (std::size_t p = 0; p < volumes.size(); ++p) missing[p] = volumes[p] - missing[p];
  return missing;
}

bool are_right(const std::vector<double>& missing, const std::vector<double>& volumes) {
  for (std::size_t p = 0; p < volumes.size(); ++p)
    if (!(std::abs(missing[p]) < kSameVolume * volumes[p])) return false;
  return true;
}

/// True once all are right.
bool step_to_volumes(const Borders& borders, const std::vector<double>& volumes, const Room& room,
                     FilledSolid& filled) {
  std::vector<double> missing = missing_of(volumes, filled);
  if (are_right(missing, volumes)) return true;
  for (const Border& own : borders.within) move(own, missing_of(volumes, filled), room, filled.mesh);
  if (!borders.within.empty()) missing = missing_of(volumes, filled);  // those around them have lost or won
  for (std::size_t p = 0; p < missing.size(); ++p)
    if (borders.lies_within[p]) missing[p] = 0;
  move(borders.outer, missing, room, filled.mesh);
  return false;
}

}  // namespace

std::vector<double> volumes_of(const FilledSolid& filled, std::size_t parts) {
  std::vector<double> volumes(parts, 0);
  for (std::size_t t = 0; t < filled.part.size(); ++t)
    volumes[filled.part[t] - 1] += tet_volume(filled.mesh, filled.mesh.tetrahedra[t]);
  return volumes;
}

void match_volumes(const std::vector<double>& volumes, const Room& room, FilledSolid& filled) {
  const Borders borders = borders_of(filled, volumes.size());
  for (int i = 0; i < kSteps && !step_to_volumes(borders, volumes, room, filled); ++i) continue;
}

}  // namespace palpate
