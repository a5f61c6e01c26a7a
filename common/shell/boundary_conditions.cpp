#include "common/shell/boundary_conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/fem/selection.hpp"
#include "common/geometry/rigid_motions.hpp"
#include "common/shell/assembly.hpp"

namespace palpate {
namespace {

int remaining_rigid_motions(const ShellMesh& mesh, const ShellDofs& dofs) {
  std::vector<Eigen::Vector3d> used;
  for (int node = 0; node < dofs.nodes(); ++node)
    if (dofs.index(node, 0) != ShellDofs::kUnused) used.push_back(mesh.nodes[node]);
  RigidMotions motions(used);
  for (int node = 0; node < dofs.nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis) {
      if (dofs.index(node, axis) == ShellDofs::kFixed) motions.hold(mesh.nodes[node], axis);
      if (dofs.index(node, 3 + axis) == ShellDofs::kFixed) motions.hold_rotation(axis);
    }
  return motions.free();
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
