#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "common/fem/direct.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// The full system of a body.
struct DirectProblem {
  TetMesh mesh;
  std::function<StaticSolution(const std::vector<Constraint>&, const StaticLoads&)> solve;
  StaticLoads rest = {};  ///< under which it is in the shape from which displacements count
};

/// Of tetrahedra.
DirectProblem direct_problem_of(StaticProblem problem);

/// A static state as lists with one entry a node.
struct StaticField {
  const std::vector<int>& held;                  ///< places in the lists, ascending
  const std::vector<Eigen::Vector3d>& position;  ///< [m] at rest
  std::vector<Eigen::Vector3d>& displacement;    ///< [m]
  std::vector<Eigen::Vector3d>& force;           ///< [N] on the tissue
};

}  // namespace palpate
