#include "common/shell/boundary_conditions.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "common/fem/selection.hpp"
#include "common/shell/assembly.hpp"

namespace palpate {
namespace {

/// How many of the six rigid-body motions the fixed dofs leave free: the rank of the rows that the motions (a
/// translation, and a rotation about the centre times the size) have at them.
int remaining_rigid_motions(const ShellMesh& mesh, const ShellDofs& dofs) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  int used = 0;
  for (int node = 0; node < dofs.nodes(); ++node) {
    if (dofs.index(node, 0) == ShellDofs::kUnused) continue;
    centre += mesh.nodes[node];
    ++used;
  }
  centre /= used;
  double size = 0;
  for (int node = 0; node < dofs.nodes(); ++node)
    if (dofs.index(node, 0) != ShellDofs::kUnused) size = std::max(size, (mesh.nodes[node] - centre).norm());

  Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Zero();
  for (int node = 0; node < dofs.nodes(); ++node)
    for (int dof = 0; dof < 6; ++dof) {
      if (dofs.index(node, dof) != ShellDofs::kFixed) continue;
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(dof % 3);
      Eigen::Matrix<double, 6, 1> row;
      if (dof < 3)
        row << axis, ((mesh.nodes[node] - centre) / size).cross(axis);
      else
        row << Eigen::Vector3d::Zero(), axis;
      gram += row * row.transpose();
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(gram, Eigen::EigenvaluesOnly);
  const double largest = eigen.eigenvalues().maxCoeff();
  // Eigenvalues are squares: 1e-10 stands for points within 1e-5 of the body's size of a line.
  return static_cast<int>((eigen.eigenvalues().array() <= 1e-10 * largest).count());
}

void fix_region(const ShellBoundaryCondition& region, const std::vector<int>& nodes, ShellDofs& dofs) {
  for (int node : nodes)
    for (int axis = 0; axis < 3; ++axis) {
      if (region.axes[axis]) dofs.fix(node, axis);
      if (region.rotations) dofs.fix(node, 3 + axis);
    }
}

}  // namespace

std::vector<int> select_nodes(const ShellMesh& mesh, const Selector& selector, const std::string& where) {
  return select_nodes(mesh.nodes, mesh.groups, used_shell_nodes(mesh), selector, where);
}

ShellDofs apply_boundary_conditions(const ShellMesh& mesh, const ShellSpec& body, const std::string& where) {
  if (body.fixed.empty()) throw std::runtime_error(where + ": unfixed body: it has no [[body.fixed]] section");
  ShellDofs dofs(used_shell_nodes(mesh));
  for (std::size_t i = 0; i < body.fixed.size(); ++i) {
    const std::string place = fmt::format("{}: [[body.fixed]] number {}", where, i + 1);
    const auto nodes = select_nodes(mesh, body.fixed[i].where, place);
    if (nodes.empty()) throw std::runtime_error(place + ": an empty fixed set: it selects no node of the mesh");
    fix_region(body.fixed[i], nodes, dofs);
  }
  dofs.number();
  if (dofs.translations() == 0) throw std::runtime_error(where + ": every node is fixed, nothing is left to deform");
  if (const int motions = remaining_rigid_motions(mesh, dofs))
    throw std::runtime_error(
        fmt::format("{}: unfixed body: the fixed nodes leave {} rigid-body motion{} free, fix more nodes, "
                    "axes or rotations",
                    where, motions, motions == 1 ? "" : "s"));
  return dofs;
}

}  // namespace palpate
