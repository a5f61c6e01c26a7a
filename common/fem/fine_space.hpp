#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/fem/offline_spec.hpp"
#include "common/fem/solid_spec.hpp"
#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// The run-time nodes whose linear shape functions do not vanish at a point, with their values there.
struct Interpolation {
  std::array<int, 4> node;
  std::array<double, 4> weight;
  int count;
};

/// The displacements from which tensors are computed offline, on the run-time mesh or a refinement of it. The first
/// nodes are those of the run-time mesh, with their numbers.
struct FineSpace {
  TetMesh mesh;         ///< corners of the elements; no groups
  int per_element = 4;  ///< nodes: 4, or 10 with the midpoints of the edges (kTetEdges) behind the corners
  int children = 1;     ///< elements per tetrahedron of the run-time mesh: element e lies in tetrahedron e / children
  std::vector<Eigen::Vector3d> nodes;         ///< [m]
  std::vector<std::array<int, 10>> elements;  ///< the first `per_element` count
  std::vector<Interpolation> interpolation;   ///< per node
  /// Elements that share one pressure in the locking-free formulation: 1, or with linear displacements the 8 into
  /// which a tetrahedron was split; element e sees pressure e / per_pressure.
  int per_pressure = 1;
};

/// Whether the section asks for anything but linear elements on the mesh itself.
bool is_finer(const std::optional<Offline>& offline);

/// Throws std::runtime_error where the section cannot be served: one pressure for every linear element locks.
FineSpace make_fine_space(const TetMesh& mesh, const Offline& offline);

}  // namespace palpate
