#include "tools/organ/crowded_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/geometry/joined_sets.hpp"

namespace palpate {
namespace {

/// A triangle at an edge, by the corner at which it begins the edge.
struct Side {
  std::array<int, 2> edge;  ///< nodes, ascending
  int corner;               ///< 3 triangle + corner
  bool forward;             ///< the triangle goes from the lower node to the higher one
  double angle = 0;         ///< around the edge, of edges that more than two share
};

using Sides = std::vector<Side>;

int next_of(int corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

int node_at(const TriangleMesh& mesh, int corner) {
  return mesh.triangles[corner / 3][corner % 3];
}

/// Of each edge.
std::vector<Sides> sides_of(const TriangleMesh& mesh) {
  Sides all;
  for (int corner = 0; corner < static_cast<int>(3 * mesh.triangles.size()); ++corner) {
    const int a = node_at(mesh, corner), b = node_at(mesh, next_of(corner));
    all.push_back({{std::min(a, b), std::max(a, b)}, corner, a < b});
  }
  std::ranges::stable_sort(all, {}, &Side::edge);
  std::vector<Sides> edges;
  for (const Side& side : all) {
    if (edges.empty() || edges.back()[0].edge != side.edge) edges.emplace_back();
    edges.back().push_back(side);
  }
  return edges;
}

void sort_around(const TriangleMesh& mesh, Sides& sides) {
  const Eigen::Vector3d from = mesh.nodes[sides[0].edge[0]];
  const Eigen::Vector3d axis = (mesh.nodes[sides[0].edge[1]] - from).normalized(), u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  for (Side& side : sides) {
    const Eigen::Vector3d away = mesh.nodes[node_at(mesh, next_of(next_of(side.corner)))] - from;
    side.angle = std::atan2(v.dot(away), u.dot(away));
  }
  std::ranges::stable_sort(sides, {}, &Side::angle);
}

/// Normals point outward, of most of what is enclosed.
bool is_outward(const TriangleMesh& mesh) {
  double volume = 0;
  const Eigen::Vector3d from = mesh.nodes[mesh.triangles[0][0]];
  for (const auto& [a, b, c] : mesh.triangles)
    volume += (mesh.nodes[a] - from).dot((mesh.nodes[b] - from).cross(mesh.nodes[c] - from));
  return volume >= 0;
}

/// The sides of an edge by what belongs together.
std::vector<Sides> sheets_at(const TriangleMesh& mesh, Sides sides, bool outward) {
  if (sides.size() < 4 || sides.size() % 2 != 0) return {sides};
  sort_around(mesh, sides);
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].forward == sides[i - 1].forward) return {sides};
  // The normal of a forward one points to larger angles: material begins at a backward one.
  if (sides[0].forward == outward) std::rotate(sides.begin(), sides.begin() + 1, sides.end());
  std::vector<Sides> sheets;
  for (std::size_t i = 0; i < sides.size(); i += 2) sheets.push_back({sides[i], sides[i + 1]});
  return sheets;
}

void join_ends(const Sides& sheet, JoinedSets& corners) {
  const auto end = [](const Side& side, bool lower) {
    return side.forward == lower ? side.corner : next_of(side.corner);
  };
  for (const Side& side : sheet)
    for (const bool lower : {true, false}) corners.join(end(sheet[0], lower), end(side, lower));
}

/// The first of a node's sheets keeps it, each other one has a copy.
void copy_nodes(TriangleMesh& mesh, const std::set<int>& shared, JoinedSets& corners) {
  std::map<int, int> node_of;  // leading corner
  std::set<int> kept;
  for (int corner = 0; corner < static_cast<int>(3 * mesh.triangles.size()); ++corner) {
    int& node = mesh.triangles[corner / 3][corner % 3];
    if (!shared.contains(node)) continue;
    const auto [known, is_new] = node_of.try_emplace(corners.leader(corner), node);
    if (is_new && !kept.insert(node).second) {
      known->second = static_cast<int>(mesh.nodes.size());
      mesh.nodes.push_back(mesh.nodes[node]);
    }
    node = known->second;
  }
}

/// Whether two sheets have both ends of an edge in common: they hang together elsewhere.
bool still_shared(const TriangleMesh& mesh, const std::vector<Sides>& sheets) {
  std::set<std::array<int, 2>> ends;
  for (const Sides& sheet : sheets) {
    const int a = node_at(mesh, sheet[0].corner), b = node_at(mesh, next_of(sheet[0].corner));
    if (!ends.insert({std::min(a, b), std::max(a, b)}).second) return true;
  }
  return false;
}

/// Cuts the triangles whose edges have a node in the middle: `middle` by the corner that begins the edge.
void cut_at_middles(TriangleMesh& mesh, const std::map<int, int>& middle) {
  std::set<int> cut;
  for (const auto& [corner, node] : middle) cut.insert(corner / 3);
  for (const int t : cut) {
    std::vector<int> around;
    std::size_t first = 0;
    for (int corner = 3 * t; corner < 3 * t + 3; ++corner) {
      around.push_back(node_at(mesh, corner));
      if (!middle.contains(corner)) continue;
      first = around.size();
      around.push_back(middle.at(corner));
    }
    std::rotate(around.begin(), around.begin() + static_cast<std::ptrdiff_t>(first), around.end());
    mesh.triangles[t] = {around[0], around[1], around[2]};
    for (std::size_t c = 3; c < around.size(); ++c) mesh.triangles.push_back({around[0], around[c - 1], around[c]});
  }
}

}  // namespace

void part_crowded_edges(TriangleMesh& mesh) {
  const bool outward = is_outward(mesh);
  JoinedSets corners(3 * mesh.triangles.size());
  std::vector<std::vector<Sides>> crowded;  // the sheets at each edge of several
  std::set<int> shared;
  for (const Sides& sides : sides_of(mesh)) {
    const std::vector<Sides> sheets = sheets_at(mesh, sides, outward);
    for (const Sides& sheet : sheets) join_ends(sheet, corners);
    if (sheets.size() == 1) continue;
    crowded.push_back(sheets);
    shared.insert(sides[0].edge.begin(), sides[0].edge.end());
  }
  copy_nodes(mesh, shared, corners);
  std::map<int, int> middle;
  for (const std::vector<Sides>& sheets : crowded) {
    if (!still_shared(mesh, sheets)) continue;
    for (const Sides& sheet : sheets) {
      for (const Side& side : sheet) middle[side.corner] = static_cast<int>(mesh.nodes.size());
      const int a = node_at(mesh, sheet[0].corner), b = node_at(mesh, next_of(sheet[0].corner));
      mesh.nodes.push_back(0.5 * (mesh.nodes[a] + mesh.nodes[b]));
    }
  }
  cut_at_middles(mesh, middle);
}

}  // namespace palpate
