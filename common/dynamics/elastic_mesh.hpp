#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "common/fem/solid_spec.hpp"
#include "common/fem/tet_element.hpp"

namespace palpate {

struct Archive;

/// What every dynamic model is built from: rest shape, tetrahedra, materials and boundary conditions. Nodes are
/// numbered as in the body's archive (its SurfaceMap), tetrahedra by their place here; both stay valid through cuts.
struct ElasticMesh {
  std::vector<Eigen::Vector3d> rest;           ///< [m] per node
  std::vector<std::array<int, 4>> tetrahedra;  ///< positively oriented
  std::vector<std::array<bool, 3>> fixed;      ///< per node and axis
  std::vector<Material> materials;             ///< the body's own first
  std::vector<std::uint16_t> material_of;      ///< index into materials per tetrahedron; empty: all have the first
  TetElement element = TetElement::linear;     ///< of all tetrahedra, for solves of the same body
  std::vector<Eigen::Vector3d> load;           ///< [N] dead load per node, while it has a tetrahedron; empty: none

  const Material& material(int t) const { return materials[material_of.empty() ? 0 : material_of[t]]; }
  /// `load`, with zeros where there is none.
  std::vector<Eigen::Vector3d> dead_loads() const;
  int nodes() const { return static_cast<int>(rest.size()); }
};

/// The part of a body that moves with inertia, from its archive (the header suffices). Throws
/// std::runtime_error if no part does.
ElasticMesh elastic_mesh(const Archive& archive, TetElement element = TetElement::linear);

}  // namespace palpate
