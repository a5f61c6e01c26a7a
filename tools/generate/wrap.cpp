#include "tools/generate/wrap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numbers>

namespace palpate {
namespace {

constexpr int kMorphSteps = 60, kRelaxPerStep = 4, kFinalRelax = 200;

using Edge = std::array<int, 2>;

Edge edge_of(int a, int b) {
  return {std::min(a, b), std::max(a, b)};
}

Eigen::Vector3d area_vector(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  return 0.5 * (mesh.nodes[t[1]] - mesh.nodes[t[0]]).cross(mesh.nodes[t[2]] - mesh.nodes[t[0]]);
}

// The angle at `apex` over the edge a-b.
double angle(const TriangleMesh& mesh, int apex, int a, int b) {
  const Eigen::Vector3d u = mesh.nodes[a] - mesh.nodes[apex], v = mesh.nodes[b] - mesh.nodes[apex];
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

// Turns triangle so that it reads {a, b, apex} with a < b or b < a as it runs along the edge.
std::array<int, 3> starting_at(const std::array<int, 3>& t, const Edge& edge) {
  for (int c = 0; c < 3; ++c) {
    if (edge_of(t[c], t[(c + 1) % 3]) == edge) return {t[c], t[(c + 1) % 3], t[(c + 2) % 3]};
  }
  return t;
}

bool flip(TriangleMesh& mesh, int first, int second, const Edge& edge,
          const std::map<Edge, std::array<int, 2>>& edges) {
  const auto [a, b, c] = starting_at(mesh.triangles[first], edge);
  const int d = starting_at(mesh.triangles[second], edge)[2];
  if (angle(mesh, c, a, b) + angle(mesh, d, a, b) <= std::numbers::pi + 1e-6) return false;
  if (edges.contains(edge_of(c, d))) return false;
  const std::array<int, 3> left{c, d, b}, right{d, c, a};
  const Eigen::Vector3d normal = area_vector(mesh, mesh.triangles[first]) + area_vector(mesh, mesh.triangles[second]);
  if (area_vector(mesh, left).dot(normal) <= 0 || area_vector(mesh, right).dot(normal) <= 0) return false;
  mesh.triangles[first] = left;
  mesh.triangles[second] = right;
  return true;
}

// One sweep over the edges; a triangle changes at most once in it.
int flip_edges(TriangleMesh& mesh) {
  std::map<Edge, std::array<int, 2>> edges;
  for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i) {
    for (int c = 0; c < 3; ++c) {
      const Edge edge = edge_of(mesh.triangles[i][c], mesh.triangles[i][(c + 1) % 3]);
      const auto [place, is_new] = edges.emplace(edge, std::array{i, -1});
      if (!is_new) place->second[1] = i;
    }
  }
  std::vector<char> changed(mesh.triangles.size(), 0);
  int flips = 0;
  for (const auto& [edge, sides] : edges) {
    if (changed[sides[0]] || changed[sides[1]] || !flip(mesh, sides[0], sides[1], edge, edges)) continue;
    changed[sides[0]] = changed[sides[1]] = 1;
    ++flips;
  }
  return flips;
}

// Moves each node along the surface towards the centroid of its triangles, large ones pulling more.
void relax(TriangleMesh& mesh, const ImplicitShape& shape) {
  std::vector<Eigen::Vector3d> sum(mesh.nodes.size(), Eigen::Vector3d::Zero());
  std::vector<double> weight(mesh.nodes.size(), 0);
  for (const auto& t : mesh.triangles) {
    const double area = area_vector(mesh, t).norm();
    const Eigen::Vector3d centroid = (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]]) / 3;
    for (int n : t) {
      sum[n] += area * centroid;
      weight[n] += area;
    }
  }
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Eigen::Vector3d normal = gradient(shape, mesh.nodes[n]).normalized();
    const Eigen::Vector3d move = sum[n] / weight[n] - mesh.nodes[n];
    mesh.nodes[n] = project(shape, mesh.nodes[n] + move - normal.dot(move) * normal);
  }
}

}  // namespace

TriangleMesh geodesic_sphere(int frequency) {
  const double g = std::numbers::phi;
  const std::vector<Eigen::Vector3d> corner{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                            {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  constexpr int kFaces[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  TriangleMesh mesh;
  std::map<std::vector<std::array<int, 2>>, int> known;  // by (corner, weight) with weight > 0
  const auto node = [&](const int* face, int i, int j) {
    const std::array<int, 3> weights{frequency - i - j, i, j};
    std::vector<std::array<int, 2>> key;
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c) {
      p += weights[c] * corner[face[c]];
      if (weights[c] > 0) key.push_back({face[c], weights[c]});
    }
    std::sort(key.begin(), key.end());
    const auto [place, is_new] = known.emplace(key, static_cast<int>(mesh.nodes.size()));
    if (is_new) mesh.nodes.push_back(p.normalized());
    return place->second;
  };
  for (const auto& face : kFaces) {
    for (int i = 0; i < frequency; ++i) {
      for (int j = 0; i + j < frequency; ++j) {
        mesh.triangles.push_back({node(face, i, j), node(face, i + 1, j), node(face, i, j + 1)});
        if (i + j + 1 < frequency) {
          mesh.triangles.push_back({node(face, i + 1, j), node(face, i + 1, j + 1), node(face, i, j + 1)});
        }
      }
    }
  }
  return mesh;
}

TriangleMesh wrap(const ImplicitShape& shape, const Eigen::Vector3d& start, int frequency) {
  TriangleMesh mesh = geodesic_sphere(frequency);
  for (auto& x : mesh.nodes) x = x.cwiseProduct(start);
  for (int step = 0; step <= kMorphSteps; ++step) {
    const double share = static_cast<double>(step) / kMorphSteps;
    const ImplicitShape between = [&](const Eigen::Vector3d& p) {
      return (1 - share) * ellipsoid(p, Eigen::Vector3d::Zero(), start) + share * shape(p);
    };
    const int rounds = step < kMorphSteps ? kRelaxPerStep : kFinalRelax;
    for (int round = 0; round < rounds; ++round) {
      relax(mesh, between);
      flip_edges(mesh);
    }
  }
  return mesh;
}

}  // namespace palpate
