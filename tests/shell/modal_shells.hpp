#pragma once
#include <functional>

#include "common/fem/factorisation.hpp"
#include "common/mesh/shell_generators.hpp"
#include "common/shell/shell_system.hpp"

namespace palpate::testing {

/// The square plate of NAFEMS: 10 x 10 x 0.05 m of steel.
constexpr ShellMaterial kSteel{200e9, 0.3, 8000, 0.05};
constexpr double kSide = 10;

/// `cells` x `cells` squares of two triangles, diagonals alternating; node j * (cells + 1) + i at (i, j) *
/// side / cells.
inline ShellMesh square_plate(int cells, double side = kSide) {
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
  return make_shell_system(mesh, material, Bending::discrete_kirchhoff, std::move(dofs), "test");
}

/// Plate in bending alone, its edges held but free to turn across the edge.
inline ShellSystem supported_plate(int cells) {
  return make_system(square_plate(cells), kSteel, [](const Eigen::Vector3d& x, int dof) {
    const bool edge_x = x[0] == 0 || x[0] == kSide, edge_y = x[1] == 0 || x[1] == kSide;
    return dof <= 1 || dof == 5 || (dof == 2 && (edge_x || edge_y)) || (dof == 3 && edge_x) ||
           (dof == 4 && edge_y);
  });
}

/// A soft duct about the z axis, 60 mm long, 9 mm wide, 0.8 mm thick, clamped at z = 0.
constexpr ShellMaterial kDuct{1e5, 0.45, 1050, 0.0008};
inline ShellSystem duct(int around, int along) {
  return make_system(make_tube(0.0045, 0.06, around, along), kDuct,
                     [](const Eigen::Vector3d& x, int) { return x[2] < 1e-9; });
}

/// Displacement under forces on the translations, without moments.
inline Eigen::VectorXd static_solution(const ShellSystem& system, const Eigen::VectorXd& force) {
  Factorisation factor(system.stiffness);
  factor.factorise(system.stiffness);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(system.stiffness.rows());
  load.head(force.size()) = force;
  return factor.solve(load).topRows(force.size());
}

}  // namespace palpate::testing
