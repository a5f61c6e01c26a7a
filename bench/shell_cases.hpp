#pragma once
#include <cmath>
#include <numbers>
#include <string>

#include "bench/shell_grids.hpp"
#include "common/fem/factorisation.hpp"
#include "common/shell/assembly.hpp"

/// Published static cases of thin shells. Each is defined by its size and load; where it is symmetric a part
/// is meshed.
namespace palpate::bench {

/// A shell with supports and dead loads, and the displacement that the publication gives.
struct ShellCase {
  ShellMesh mesh;
  ShellMaterial material;
  ShellDofs dofs;
  std::vector<Eigen::Vector3d> load;  ///< [N] per node
  int watched = 0;                    ///< node
  Eigen::Vector3d along;              ///< unit vector
  double target = 0;                  ///< [m] displacement of the watched node along it

  ShellCase(ShellMesh shell, const ShellMaterial& stuff)
      : mesh(std::move(shell)),
        material(stuff),
        dofs(used_shell_nodes(mesh)),
        load(mesh.nodes.size(), Eigen::Vector3d::Zero()) {}

  /// Fixes the dofs of all nodes for which `where(x)` holds.
  template <class Where>
  void fix(Where&& where, std::initializer_list<int> fixed) {
    for (int n = 0; n < dofs.nodes(); ++n)
      for (const int dof : fixed)
        if (where(mesh.nodes[n])) dofs.fix(n, dof);
  }
  /// A plane of symmetry with its normal along an axis.
  template <class Where>
  void mirror(Where&& where, int axis) {
    fix(where, {axis, 3 + (axis + 1) % 3, 3 + (axis + 2) % 3});
  }
  void watch(int node, const Eigen::Vector3d& direction, double value) {
    watched = node;
    along = direction;
    target = value;
  }
  /// A load per area [N/m^2], a third of each triangle's at its corners.
  void spread(const Eigen::Vector3d& per_area) {
    const ShellMaterial unit{.density = 1, .thickness = 1};
    const auto area = lumped_shell_mass(mesh, unit);
    for (std::size_t n = 0; n < load.size(); ++n) load[n] += area[n] * per_area;
  }
};

struct ShellAnswer {
  Eigen::VectorXd displacement;  ///< by free dof
  double value;                  ///< [m] where the case looks
  int size;                      ///< free dofs
};

inline Eigen::VectorXd load_vector(const ShellCase& shell) {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(shell.dofs.size());
  for (int i = 0; i < shell.dofs.translations(); ++i)
    load[i] = shell.load[shell.dofs.dof(i) / 6][shell.dofs.dof(i) % 6];
  return load;
}

inline ShellAnswer solve(ShellCase& shell, Bending bending = Bending::discrete_kirchhoff) {
  shell.dofs.number();
  const auto stiffness = assemble_shell_stiffness(shell.mesh, shell.material, bending, shell.dofs, "case");
  Factorisation factor(stiffness);
  factor.factorise(stiffness);
  ShellAnswer answer{factor.solve(load_vector(shell)), 0, shell.dofs.size()};
  for (int axis = 0; axis < 3; ++axis) {
    const int index = shell.dofs.index(shell.watched, axis);
    if (index >= 0) answer.value += shell.along[axis] * answer.displacement[index];
  }
  return answer;
}

inline bool near(double a, double b) {
  return std::abs(a - b) < 1e-9;
}

/// Roof under its weight: middle of the free edge goes down (MacNeal and Harder 1985).
inline ShellCase scordelis_lo(int n, Diagonals diagonals = Diagonals::alternating) {
  const double radius = 25, half_length = 25, half_angle = 40 * std::numbers::pi / 180;
  const auto roof = [&](double u, double v) -> Eigen::Vector3d {
    return {radius * std::sin(half_angle * u), half_length * v, radius * std::cos(half_angle * u)};
  };
  ShellCase shell(shell_grid(n, n, roof, diagonals), {4.32e8, 0, 0, 0.25});
  shell.mirror([](auto& x) { return near(x.x(), 0); }, 0);
  shell.mirror([](auto& x) { return near(x.y(), 0); }, 1);
  shell.fix([=](auto& x) { return near(x.y(), half_length); }, {0, 2});
  shell.spread({0, 0, -90});
  shell.watch(n, {0, 0, -1}, 0.3024);
  return shell;
}

/// Cylinder between end diaphragms, pinched by two forces of 1 N: an eighth of it.
inline ShellCase pinched_cylinder(int n, Diagonals diagonals = Diagonals::alternating) {
  const double radius = 300, half_length = 300, quarter = std::numbers::pi / 2;
  const auto wall = [&](double u, double v) -> Eigen::Vector3d {
    return {radius * std::sin(quarter * u), half_length * v, radius * std::cos(quarter * u)};
  };
  ShellCase shell(shell_grid(n, n, wall, diagonals), {3e6, 0.3, 0, 3});
  shell.mirror([](auto& x) { return near(x.x(), 0); }, 0);
  shell.mirror([](auto& x) { return near(x.y(), 0); }, 1);
  shell.mirror([](auto& x) { return near(x.z(), 0); }, 2);
  shell.fix([=](auto& x) { return near(x.y(), half_length); }, {0, 2});
  shell.load[0].z() = -0.25;
  shell.watch(0, {0, 0, -1}, 1.8248e-5);
  return shell;
}

/// Closed hemisphere, pulled along x and pressed along y at its rim: a quarter of it.
inline ShellCase hemisphere(int n) {
  ShellCase shell(sphere_octant(n, 10), {6.825e7, 0.3, 0, 0.04});
  shell.mirror([](auto& x) { return near(x.x(), 0); }, 0);
  shell.mirror([](auto& x) { return near(x.y(), 0); }, 1);
  shell.fix([](auto& x) { return near(x.z(), 10); }, {2});
  shell.load[0].x() = 1;
  shell.load[n].y() = -1;
  shell.watch(0, {1, 0, 0}, 0.0924);
  return shell;
}

/// Strip twisted by a quarter turn, clamped at its root, loaded on its end along its width (in plane) or
/// across it: 3 n x n cells. The thin beam's loads are a millionth.
inline ShellCase twisted_beam(int n, bool in_plane, double thickness = 0.32,
                              Diagonals diagonals = Diagonals::alternating) {
  const double length = 12, width = 1.1;
  const auto strip = [&](double u, double v) -> Eigen::Vector3d {
    const double turn = std::numbers::pi / 2 * u, y = width * (v - 0.5);
    return {length * u, y * std::cos(turn), y * std::sin(turn)};
  };
  ShellCase shell(shell_grid(3 * n, n, strip, diagonals), {2.9e7, 0.22, 0, thickness});
  const bool thin = thickness < 0.01;
  shell.fix([](auto& x) { return near(x.x(), 0); }, {0, 1, 2, 3, 4, 5});
  const Eigen::Vector3d along = in_plane ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
  const int row = 3 * n + 1;
  for (int j = 0; j <= n; ++j) shell.load[row * j + 3 * n] = (j % n ? 1.0 : 0.5) / n * (thin ? 1e-6 : 1.0) * along;
  const double target = in_plane ? (thin ? 5.256e-3 : 5.42453e-3) : (thin ? 1.294e-3 : 1.75325e-3);
  shell.watch(row * (n / 2) + 3 * n, along, target);
  return shell;
}

/// Square plate on simple supports, a quarter of it, under pressure or a force at its centre; `aspect` 1
/// or 5.
inline ShellCase square_plate(int n, bool pressed, double aspect = 1, Diagonals diagonals = Diagonals::alternating) {
  const auto plate = [=](double u, double v) -> Eigen::Vector3d { return {u, aspect * v, 0}; };
  ShellCase shell(shell_grid(n, n, plate, diagonals), {1.7472e7, 0.3, 0, 1e-4});
  shell.mirror([](auto& x) { return near(x.x(), 0); }, 0);
  shell.mirror([](auto& x) { return near(x.y(), 0); }, 1);
  shell.fix([](auto& x) { return near(x.x(), 1); }, {2, 3});
  shell.fix([=](auto& x) { return near(x.y(), aspect); }, {2, 4});
  if (pressed)
    shell.spread({0, 0, -1e-4});
  else
    shell.load[0].z() = -1e-4;
  const bool square = aspect == 1;
  shell.watch(0, {0, 0, -1}, pressed ? (square ? 4.062 : 12.97) : (square ? 11.60 : 16.96));
  return shell;
}

/// Hyperbolic paraboloid clamped along one straight side, under its weight.
inline ShellCase clamped_hypar(int n, Diagonals diagonals = Diagonals::alternating) {
  const auto saddle = [](double u, double v) -> Eigen::Vector3d {
    const double x = u - 0.5, y = v - 0.5;
    return {x, y, x * x - y * y};
  };
  ShellCase shell(shell_grid(n, n, saddle, diagonals), {2e11, 0.3, 0, 0.01});
  shell.fix([](auto& x) { return near(x.x(), -0.5); }, {0, 1, 2, 3, 4, 5});
  shell.spread({0, 0, -80});
  shell.watch((n + 1) * (n / 2) + n, {0, 0, -1}, 9.3355e-5);
  return shell;
}

}  // namespace palpate::bench
