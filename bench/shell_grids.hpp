#pragma once
#include <Eigen/Core>
#include <functional>

#include "common/mesh/shell_mesh.hpp"

/// Regular shell meshes for published cases.
namespace palpate::bench {

enum class Diagonals {
  alike,        ///< all cells cut along the same diagonal
  alternating,  ///< like a chess board: the cuts meet in every second node
};

/// A place of space for u, v in 0..1.
using Chart = std::function<Eigen::Vector3d(double u, double v)>;

/// (nu + 1) x (nv + 1) nodes, node i + (nu + 1) j at u = i / nu, v = j / nv; triangles counterclockwise in u,
/// v.
inline ShellMesh shell_grid(int nu, int nv, const Chart& chart, Diagonals diagonals) {
  ShellMesh mesh;
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) mesh.nodes.push_back(chart(double(i) / nu, double(j) / nv));
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i) {
      const int a = i + (nu + 1) * j, b = a + 1, d = a + nu + 1, c = d + 1;
      const bool falling = diagonals == Diagonals::alternating && (i + j) % 2 == 1;
      if (falling)
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {c, d, b}});
      else
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
    }
  return mesh;
}

/// The eighth x, y, z >= 0 of a sphere, each side cut into n. Corner nodes: 0 on x, n on y, the last on z.
inline ShellMesh sphere_octant(int n, double radius) {
  ShellMesh mesh;
  const auto node = [n](int i, int j) { return j * (n + 1) - j * (j - 1) / 2 + i; };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n - j; ++i) mesh.nodes.push_back(radius * Eigen::Vector3d(n - i - j, i, j).normalized());
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n - j; ++i) {
      mesh.triangles.push_back({node(i, j), node(i + 1, j), node(i, j + 1)});
      if (i + j < n - 1) mesh.triangles.push_back({node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)});
    }
  return mesh;
}

}  // namespace palpate::bench
