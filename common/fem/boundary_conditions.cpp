#include "common/fem/boundary_conditions.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/fem/selection.hpp"
#include "common/geometry/rigid_motions.hpp"

namespace palpate {

DofMap::DofMap(const TetMesh& mesh) : DofMap(used_nodes(mesh)) {}

DofMap::DofMap(const std::vector<char>& used) : index_(3 * used.size(), kUnused) {
  for (std::size_t i = 0; i < index_.size(); ++i)
    if (used[i / 3]) index_[i] = 0;
  number();
}

void DofMap::number() {
  dof_.clear();
  for (int i = 0; i < static_cast<int>(index_.size()); ++i) {
    if (index_[i] < 0) continue;
    index_[i] = static_cast<int>(dof_.size());
    dof_.push_back(i);
  }
}

int remaining_rigid_motions(const TetMesh& mesh, const DofMap& dofs) {
  std::vector<Eigen::Vector3d> used;
  for (int node = 0; node < dofs.nodes(); ++node)
    if (dofs.index(node, 0) != DofMap::kUnused) used.push_back(mesh.nodes[node]);
  RigidMotions motions(used);
  for (int node = 0; node < dofs.nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (dofs.index(node, axis) == DofMap::kFixed) motions.hold(mesh.nodes[node], axis);
  return motions.free();
}

Eigen::VectorXd gather(const DofMap& dofs, const std::vector<Eigen::Vector3d>& field) {
  Eigen::VectorXd values(dofs.size());
  for (int i = 0; i < dofs.size(); ++i) values[i] = field[dofs.dof(i) / 3][dofs.dof(i) % 3];
  return values;
}

DofMap apply_boundary_conditions(const TetMesh& mesh, const std::vector<BoundaryCondition>& regions,
                                 const std::string& where) {
  if (regions.empty()) throw std::runtime_error(where + ": unfixed body: it has no [[body.fixed]] section");
  DofMap dofs(mesh);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const std::string place = fmt::format("{}: [[body.fixed]] number {}", where, i + 1);
    const auto nodes = select_nodes(mesh, regions[i].where, place);
    const auto& axes = regions[i].axes;
    if (nodes.empty()) throw std::runtime_error(place + ": an empty fixed set: it selects no node of the mesh");
    if (!axes[0] && !axes[1] && !axes[2]) throw std::runtime_error(place + ": an empty fixed set: it names no axis");
    for (int node : nodes)
      for (int axis = 0; axis < 3; ++axis)
        if (axes[axis]) dofs.fix(node, axis);
  }
  dofs.number();
  if (dofs.size() == 0) throw std::runtime_error(where + ": every node is fixed, nothing is left to deform");
  if (const int motions = remaining_rigid_motions(mesh, dofs))
    throw std::runtime_error(
        fmt::format("{}: unfixed body: the fixed nodes leave {} rigid-body motion{} free, fix more nodes or axes",
                    where, motions, motions == 1 ? "" : "s"));
  return dofs;
}

}  // namespace palpate
