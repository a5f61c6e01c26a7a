#include "common/mesh/shell_quality.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "common/mesh/faults.hpp"

namespace palpate {
namespace {

using Edge = std::array<int, 2>;

/// A triangle's side: `along` says that the triangle runs from the lower node number to the higher.
struct Side {
  int triangle;
  bool along;
};

using Edges = std::map<Edge, std::vector<Side>>;

Edges collect_edges(std::span<const std::array<int, 3>> triangles) {
  Edges edges;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    for (int c = 0; c < 3; ++c) {
      const int a = triangles[t][c], b = triangles[t][(c + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}].push_back({t, a < b});
    }
  return edges;
}

void check_numbers_and_coordinates(const ShellMesh& mesh, FaultList& faults) {
  const int count = static_cast<int>(mesh.nodes.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int n : mesh.triangles[t])
      if (n < 0 || n >= count)
        faults.add(fmt::format("triangle {}: node {} does not exist, the mesh has {} nodes", t, n, count));
  for (int n = 0; n < count; ++n)
    if (!mesh.nodes[n].allFinite()) faults.add(fmt::format("node {} has a coordinate that is not a finite number", n));
}

void check_shapes(const ShellMesh& mesh, FaultList& faults) {
  std::map<std::array<int, 3>, std::size_t> first;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<int, 3> key = mesh.triangles[t];
    std::sort(key.begin(), key.end());
    const auto twice = std::adjacent_find(key.begin(), key.end());
    if (twice != key.end()) {
      faults.add(fmt::format("triangle {}: degenerate, it uses node {} twice", t, *twice));
      continue;
    }
    const auto [place, is_new] = first.emplace(key, t);
    if (!is_new) faults.add(fmt::format("triangle {}: the same triangle as triangle {}", t, place->second));
    const double shape = triangle_shape(mesh, mesh.triangles[t]);
    if (!(shape >= kDegenerateTriangle))
      faults.add(fmt::format(
          "triangle {}: degenerate, its three nodes lie on a line (shape {:.1e}, at least {:.0e} is needed)", t, shape,
          kDegenerateTriangle));
  }
}

void check_edges(const Edges& edges, FaultList& faults) {
  for (const auto& [nodes, sides] : edges) {
    if (sides.size() > 2) {
      faults.add(fmt::format("triangle {}: {} triangles share the edge between nodes {} and {}, two at most can",
                             sides[2].triangle, sides.size(), nodes[0], nodes[1]));
    } else if (sides.size() == 2 && sides[0].along == sides[1].along) {
      faults.add(fmt::format("triangle {}: turned against triangle {}, with which it shares an edge", sides[1].triangle,
                             sides[0].triangle));
    }
  }
}

/// Triangles by connected part across edges.
std::vector<std::vector<int>> connected_parts(int triangles, const Edges& edges) {
  std::vector<std::vector<int>> beside(triangles);
  for (const auto& [nodes, sides] : edges)
    for (std::size_t s = 1; s < sides.size(); ++s) {
      beside[sides[0].triangle].push_back(sides[s].triangle);
      beside[sides[s].triangle].push_back(sides[0].triangle);
    }
  std::vector<std::vector<int>> parts;
  std::vector<char> seen(triangles, 0);
  for (int first = 0; first < triangles; ++first) {
    if (seen[first]) continue;
    std::vector<int> part{first};
    seen[first] = 1;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (int t : beside[part[i]])
        if (!std::exchange(seen[t], 1)) part.push_back(t);
    parts.push_back(std::move(part));
  }
  return parts;
}

void check_connection(const ShellMesh& mesh, const Edges& edges, FaultList& faults) {
  const auto parts = connected_parts(static_cast<int>(mesh.triangles.size()), edges);
  for (std::size_t p = 1; p < parts.size(); ++p)
    faults.add(
        fmt::format("triangle {}: disconnected, it and {} further triangles share no edge with triangle 0's part",
                    parts[p][0], parts[p].size() - 1));
}

// Corners of triangles at one node hang together where their triangles share an edge there.
void check_fans(const ShellMesh& mesh, const Edges& edges, FaultList& faults) {
  std::map<std::array<int, 2>, std::vector<int>> beside;  // of (node, triangle) the next triangles around the node
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int n : mesh.triangles[t]) beside[{n, static_cast<int>(t)}];
  for (const auto& [nodes, sides] : edges)
    for (std::size_t s = 1; s < sides.size(); ++s)
      for (int n : nodes) {
        beside[{n, sides[0].triangle}].push_back(sides[s].triangle);
        beside[{n, sides[s].triangle}].push_back(sides[0].triangle);
      }
  while (!beside.empty()) {
    const int node = beside.begin()->first[0];
    std::vector<int> fan{beside.begin()->first[1]};
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const auto corner = beside.extract({node, fan[i]});
      if (corner) fan.insert(fan.end(), corner.mapped().begin(), corner.mapped().end());
    }
    if (beside.empty() || beside.begin()->first[0] != node) continue;
    faults.add(fmt::format("node {}: parts of the shell meet only in it", node));
    beside.erase(beside.begin(), beside.lower_bound({node + 1, 0}));
  }
}

/// Turns the triangles of a part like its first one; how many had to be turned, or -1 on a one-sided surface.
int turn_alike(std::vector<std::array<int, 3>>& triangles, const std::vector<int>& part,
               const std::vector<std::vector<std::pair<int, bool>>>& beside, std::vector<signed char>& turned) {
  turned[part[0]] = 0;
  std::vector<int> queue{part[0]};
  int count = 0;
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (const auto& [other, same_way] : beside[queue[i]]) {
      const auto wanted = static_cast<signed char>(turned[queue[i]] ^ static_cast<int>(same_way));
      if (turned[other] >= 0 && turned[other] != wanted) return -1;
      if (turned[other] >= 0) continue;
      turned[other] = wanted;
      count += wanted;
      queue.push_back(other);
    }
  const bool most = 2 * count > static_cast<int>(part.size());
  for (int t : part)
    if ((turned[t] != 0) != most) std::swap(triangles[t][1], triangles[t][2]);
  return count;
}

double area(const ShellMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += 0.5 * (mesh.nodes[b] - mesh.nodes[a]).cross(mesh.nodes[c] - mesh.nodes[a]).norm();
  return sum;
}

}  // namespace

double triangle_shape(const ShellMesh& mesh, const std::array<int, 3>& t) {
  const Eigen::Vector3d e0 = mesh.nodes[t[1]] - mesh.nodes[t[0]], e1 = mesh.nodes[t[2]] - mesh.nodes[t[1]],
                        e2 = mesh.nodes[t[0]] - mesh.nodes[t[2]];
  const double sum = e0.squaredNorm() + e1.squaredNorm() + e2.squaredNorm();
  return sum > 0 ? 2 * std::sqrt(3.0) * e0.cross(e1).norm() / sum : 0;
}

void orient_shell(ShellMesh& mesh, const std::string& where) {
  const Edges edges = collect_edges(mesh.triangles);
  std::vector<std::vector<std::pair<int, bool>>> beside(mesh.triangles.size());
  for (const auto& [nodes, sides] : edges) {
    if (sides.size() != 2) continue;
    const bool same_way = sides[0].along == sides[1].along;
    beside[sides[0].triangle].emplace_back(sides[1].triangle, same_way);
    beside[sides[1].triangle].emplace_back(sides[0].triangle, same_way);
  }
  std::vector<signed char> turned(mesh.triangles.size(), -1);
  for (const auto& part : connected_parts(static_cast<int>(mesh.triangles.size()), edges)) {
    if (turn_alike(mesh.triangles, part, beside, turned) < 0)
      throw std::runtime_error(where + ": the surface has one side only, its triangles cannot be turned alike");
  }
  const double size = std::pow(area(mesh), 1.5), volume = enclosed_volume(mesh);
  if (!(volume < -1e-3 * size)) return;
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

void check_shell_mesh(const ShellMesh& mesh, const std::string& where) {
  if (mesh.triangles.empty()) throw std::runtime_error(where + ": the mesh has no triangles");
  FaultList faults;
  check_numbers_and_coordinates(mesh, faults);
  faults.raise(where);

  check_shapes(mesh, faults);
  faults.raise(where);

  const Edges edges = collect_edges(mesh.triangles);
  check_edges(edges, faults);
  check_connection(mesh, edges, faults);
  check_fans(mesh, edges, faults);
  faults.raise(where);
}

std::vector<std::vector<int>> boundary_loops(std::span<const std::array<int, 3>> triangles) {
  std::map<int, int> next;
  for (const auto& [nodes, sides] : collect_edges(triangles))
    if (sides.size() == 1) next[nodes[sides[0].along ? 0 : 1]] = nodes[sides[0].along ? 1 : 0];
  std::vector<std::vector<int>> loops;
  while (!next.empty()) {
    std::vector<int> loop;
    for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
      const int node = at->first, follower = at->second;
      if (loop.empty()) loop.push_back(node);
      next.erase(at);
      if (follower != loop.front()) loop.push_back(follower);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

double enclosed_volume(const ShellMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  const Eigen::Vector3d origin = mesh.nodes[mesh.triangles[0][0]];
  const auto six_fold = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    return (a - origin).cross(b - origin).dot(c - origin);
  };
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) sum += six_fold(mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]);
  for (const auto& loop : boundary_loops(mesh.triangles)) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int n : loop) middle += mesh.nodes[n];
    middle /= static_cast<double>(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i)  // against the triangles' own direction
      sum += six_fold(middle, mesh.nodes[loop[(i + 1) % loop.size()]], mesh.nodes[loop[i]]);
  }
  return sum / 6;
}

}  // namespace palpate
