#pragma once
#include <chrono>
#include <functional>

#include "common/mesh/shell_generators.hpp"
#include "common/shell/shell_system.hpp"

/// Shells with known frequencies, and a soft duct: of the benchmarks of modes and of the tests.
namespace palpate::bench {

/// The square plate of NAFEMS: 10 x 10 x 0.05 m of steel.
constexpr ShellMaterial kSteel{200e9, 0.3, 8000, 0.05};
constexpr double kSide = 10;

/// `cells` x `cells` squares of two triangles, diagonals alternating; node j * (cells + 1) + i at (i, j) *
/// side / cells.
inline ShellMesh split_squares(int cells, double side = kSide) {
  ShellMesh mesh;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) mesh.nodes.push_back({i * side / cells, j * side / cells, 0});
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i, b = a + 1, c = b + cells + 1, d = c - 1;
      if ((i + j) % 2 == 0) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  return mesh;
}

/// Fixes dof d of a node where fixed(position, d) says so.
inline ShellSystem make_system(const ShellMesh& mesh, const ShellMaterial& material,
                               const std::function<bool(const Eigen::Vector3d&, int)>& fixed) {
  ShellDofs dofs(used_shell_nodes(mesh));
  for (int node = 0; node < dofs.nodes(); ++node)
    for (int dof = 0; dof < 6; ++dof)
      if (fixed(mesh.nodes[node], dof)) dofs.fix(node, dof);
  dofs.number();
  return make_shell_system(mesh, material, Bending::discrete_kirchhoff, std::move(dofs), "shell");
}

/// Plate in bending alone, its edges held but free to turn across the edge.
inline ShellSystem supported_plate(int cells) {
  return make_system(split_squares(cells), kSteel, [](const Eigen::Vector3d& x, int dof) {
    const bool edge_x = x[0] == 0 || x[0] == kSide, edge_y = x[1] == 0 || x[1] == kSide;
    return dof <= 1 || dof == 5 || (dof == 2 && (edge_x || edge_y)) || (dof == 3 && edge_x) || (dof == 4 && edge_y);
  });
}

/// A soft duct about the z axis, 60 mm long, 9 mm wide, 0.8 mm thick, clamped at z = 0.
constexpr ShellMaterial kDuct{1e5, 0.45, 1050, 0.0008};
inline ShellSystem duct(int around, int along) {
  return make_system(make_tube(0.0045, 0.06, around, along), kDuct,
                     [](const Eigen::Vector3d& x, int) { return x[2] < 1e-9; });
}

inline ShellSystem free_plate(int cells) {
  return make_system(split_squares(cells), kSteel, [](const Eigen::Vector3d&, int) { return false; });
}

/// NAFEMS FV32: a membrane 10 m long that tapers from 5 to 1 m, its root held, moving in its plane alone.
inline ShellSystem tapered_membrane(int cells) {
  ShellMesh mesh = split_squares(cells, 1);
  for (Eigen::Vector3d& x : mesh.nodes) x = {10 * x[0], (x[1] - 0.5) * (5 - 4 * x[0]), 0};
  return make_system(mesh, kSteel, [](const Eigen::Vector3d& x, int dof) { return dof >= 2 ? dof != 5 : x[0] == 0; });
}

/// A strip 10 x 0.5 x 0.05 m without lateral contraction, clamped at one end: a beam in bending.
constexpr ShellMaterial kStrip{200e9, 0, 8000, 0.05};
constexpr double kStripLength = 10;

inline ShellSystem cantilever_strip(int cells) {
  ShellMesh mesh = split_squares(cells, 1);
  for (Eigen::Vector3d& x : mesh.nodes) x = {kStripLength * x[0], 0.5 * x[1], 0};
  return make_system(mesh, kStrip, [](const Eigen::Vector3d& x, int dof) { return dof <= 1 || dof == 5 || x[0] == 0; });
}

/// Radius 1 m, length 4 m, 1 cm of steel, the ends held round by diaphragms and free to slide along the axis.
constexpr ShellMaterial kCylinder{200e9, 0.3, 8000, 0.01};
constexpr double kCylinderRadius = 1, kCylinderLength = 4;

inline ShellSystem cylinder(int around, int along) {
  return make_system(
      make_tube(kCylinderRadius, kCylinderLength, around, along), kCylinder,
      [](const Eigen::Vector3d& x, int dof) { return dof <= 1 && (x[2] < 1e-9 || x[2] > kCylinderLength - 1e-9); });
}

/// Wall-clock time of one call.
inline double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The free translation that a tool pushes: radially, on the ring halfway along.
inline int pushed_dof(const ShellSystem& duct, int around, int along) {
  return duct.dofs.index(along / 2 * around, 0);
}

}  // namespace palpate::bench
