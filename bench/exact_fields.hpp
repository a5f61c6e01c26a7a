#pragma once
#include <functional>
#include <stdexcept>

#include "common/fem/fine_problem.hpp"

/// Solids whose faces move by a known field.
namespace palpate::bench {

using Field = std::function<Eigen::Vector3d(const Eigen::Vector3d& x)>;
/// Whether an axis is held at a place.
using Held = std::function<bool(const Eigen::Vector3d& x, int axis)>;

/// A body of one material without fixed groups: what is held is asked at every fine node itself.
inline FineProblem make_held_problem(const TetMesh& mesh, const Material& material, const Offline& offline,
                                     const Held& held) {
  MaterialField materials;
  materials.materials.push_back(material);
  DofMap run_time(mesh);
  run_time.number();
  auto problem = make_fine_problem(mesh, offline, materials, run_time, "block");
  DofMap dofs(std::vector<char>(problem.space.nodes.size(), 1));
  for (int node = 0; node < dofs.nodes(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (held(problem.space.nodes[node], axis)) dofs.fix(node, axis);
  dofs.number();
  problem.dofs = dofs;
  return problem;
}

/// Displacements under loads [N] per fine node where held axes move as `exact` says.
inline std::vector<Eigen::Vector3d> solve_held(const FineProblem& problem, const Field& exact,
                                               std::vector<Eigen::Vector3d> load) {
  std::vector<Eigen::Vector3d> held(load.size(), Eigen::Vector3d::Zero());
  for (std::size_t node = 0; node < held.size(); ++node)
    for (int axis = 0; axis < 3; ++axis)
      if (problem.dofs.index(static_cast<int>(node), axis) == DofMap::kFixed)
        held[node][axis] = exact(problem.space.nodes[node])[axis];
  const auto force =
      internal_force(problem.space, problem.materials, problem.pressures ? &*problem.pressures : nullptr, held);
  for (std::size_t node = 0; node < load.size(); ++node) load[node] -= force[node];
  auto moved = solve_fine_loads(problem, load);
  for (std::size_t node = 0; node < held.size(); ++node) moved[node] += held[node];
  return moved;
}

/// The fine node at a place; throws where there is none.
inline int node_at(const FineSpace& space, const Eigen::Vector3d& place) {
  for (std::size_t node = 0; node < space.nodes.size(); ++node)
    if ((space.nodes[node] - place).norm() < 1e-9) return static_cast<int>(node);
  throw std::runtime_error("no node at the place asked for");
}

}  // namespace palpate::bench
