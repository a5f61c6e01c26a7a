#pragma once
#include <Eigen/Geometry>
#include <random>

#include "bench/shell_grids.hpp"
#include "common/shell/assembly.hpp"

namespace palpate::testing {

inline constexpr ShellMaterial kWall{2e6, 0.3, 1100, 0.02};

/// A motion of a shell's node: displacement [m] and rotation [rad].
using ShellMotion = Eigen::Vector<double, 6>;

/// A flat patch 1.2 x 1 m in the plane z = 0, its inner nodes moved by up to a quarter of a cell.
inline ShellMesh irregular_patch(unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.25, 0.25);
  const auto inner = [](double u) { return u > 0.01 && u < 0.99; };
  return bench::shell_grid(
      4, 4,
      [&](double u, double v) -> Eigen::Vector3d {
        const double du = jitter(random) / 4, dv = jitter(random) / 4;
        const bool moved = inner(u) && inner(v);
        return {1.2 * (u + moved * du), v + moved * dv, 0};
      },
      bench::Diagonals::alternating);
}

/// A closed bent tube of changing radius.
inline ShellMesh bent_tube(int around = 10, int along = 12) {
  ShellMesh mesh = bench::shell_grid(
      around, along,
      [](double u, double v) -> Eigen::Vector3d {
        const double angle = 2 * std::numbers::pi * u, radius = 0.1 + 0.02 * std::sin(5 * v), bend = 0.8 * v;
        const double out = 0.5 + radius * std::cos(angle);
        return {out * std::cos(bend), out * std::sin(bend), radius * std::sin(angle)};
      },
      bench::Diagonals::alternating);
  // The last node of each ring is its first.
  for (auto& triangle : mesh.triangles)
    for (int& node : triangle)
      if (node % (around + 1) == around) node -= around;
  return mesh;
}

inline ShellMesh turned(ShellMesh mesh, const Eigen::Matrix3d& turn) {
  for (auto& x : mesh.nodes) x = turn * x;
  return mesh;
}

inline Eigen::Matrix3d some_turn() {
  return Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
}

/// Both halves of the stiffness against all dofs of all nodes, nothing fixed.
inline SparseMatrix whole_stiffness(const ShellMesh& mesh, const ShellDofs& free_dofs,
                                    Bending bending = Bending::discrete_kirchhoff) {
  const auto lower = assemble_shell_stiffness(mesh, kWall, bending, free_dofs, "shell");
  return lower.selfadjointView<Eigen::Lower>();
}

/// The given motion of every node, by free number.
template <class MotionAt>
Eigen::VectorXd motion_vector(const ShellMesh& mesh, const ShellDofs& dofs, MotionAt&& motion_at) {
  Eigen::VectorXd motion(dofs.size());
  for (int i = 0; i < dofs.size(); ++i) {
    const ShellMotion node = motion_at(mesh.nodes[dofs.dof(i) / 6]);
    motion[i] = node[dofs.dof(i) % 6];
  }
  return motion;
}

inline ShellDofs all_free(const ShellMesh& mesh) {
  return ShellDofs(used_shell_nodes(mesh));
}

}  // namespace palpate::testing
