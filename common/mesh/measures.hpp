#pragma once
#include <string>

#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// [kg/m^3] Of the mass that is told where no density is.
inline constexpr double kTissueDensity = 1060;

/// What a person asks of a mesh first.
struct MeshMeasures {
  Eigen::Vector3d extent;                     ///< [m] along x, y, z
  double volume;                              ///< [m^3]
  double min_angle, median_angle, max_angle;  ///< [degrees] between two faces of a tetrahedron
};

/// Of a mesh with at least one tetrahedron; the median is that of every tetrahedron's smallest angle.
MeshMeasures measures_of(const TetMesh& mesh);

/// "260 x 160 x 126 mm, 1.6e+03 ml, 1.7 kg"; `mass` [kg].
std::string say_size(const MeshMeasures& measures, double mass);
/// "dihedral angles: smallest 15.0, median 42.1, largest 151.3 degrees"
std::string say_angles(const MeshMeasures& measures);

}  // namespace palpate
