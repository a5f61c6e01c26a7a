#pragma once
#include <array>
#include <vector>

#include "common/fem/assembly.hpp"
#include "common/fem/constraint.hpp"
#include "common/fem/fine_space.hpp"

namespace palpate {

/// A pressure on a triangle of the surface.
struct SurfacePressure {
  std::array<int, 3> triangle;  ///< mesh nodes, outward by the right-hand rule
  double pressure;              ///< [Pa] against the outward normal
};

/// What linear elements make of it: a third of its force at each corner.
std::array<NodalLoad, 3> corner_loads(const SurfacePressure& pressure, const std::vector<Eigen::Vector3d>& position);

/// On each triangle whose corners are all among these nodes, which ascend; empty where there is none.
std::vector<SurfacePressure> pressures_on(const std::vector<std::array<int, 3>>& triangles,
                                          const std::vector<int>& nodes, double pressure);

/// Dead loads on a body.
struct StaticLoads {
  std::vector<NodalLoad> nodes;
  std::vector<SurfacePressure> pressures;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2]

  bool empty() const { return nodes.empty() && pressures.empty() && gravity.isZero(0); }
};

/// Consistent loads [N] per node of linear elements at these positions, without weight.
std::vector<Eigen::Vector3d> force_vector(const StaticLoads& loads, const std::vector<Eigen::Vector3d>& position);

/// The same with weight.
std::vector<Eigen::Vector3d> load_vector(const StaticLoads& loads, const TetMesh& mesh, const MaterialField& materials);

/// Consistent loads [N] per fine node of the pressures and the weight. `materials` are those of the run-time
/// tetrahedra.
std::vector<Eigen::Vector3d> fine_load_vector(const StaticLoads& loads, const FineSpace& space,
                                              const MaterialField& materials);

}  // namespace palpate
