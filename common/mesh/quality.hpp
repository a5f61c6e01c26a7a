#pragma once
#include <array>
#include <string>

#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// A tetrahedron whose shape (see tet_shape) is below this counts as degenerate. Element stiffness grows as
/// 1/shape, so a factorisation with one such element loses up to 6 of the 16 digits of double precision;
/// the tolerance of 1e-8 between the tensors and the direct solution still holds.
inline constexpr double kDegenerateShape = 1e-6;

/// Signed volume [m^3] of tetrahedron `t`; positive where det[x1-x0, x2-x0, x3-x0] > 0.
double tet_volume(const TetMesh& mesh, const std::array<int, 4>& t);

/// Signed shape of a tetrahedron: 6 sqrt(2) volume / (root mean square edge length)^3. 1 for a regular one,
/// 0 for a flat one, negative for an inverted one; does not depend on size. A collapsed one (no edges) has 0.
double tet_shape(const TetMesh& mesh, const std::array<int, 4>& t);

/// Smallest angle [rad] between two faces of a tetrahedron.
double min_dihedral_angle(const TetMesh& mesh, const std::array<int, 4>& t);

/// Refuses a mesh that cannot be computed with. Checked: node numbers in range, coordinates finite, no
/// tetrahedron degenerate, inverted or present twice, no face shared by more than two tetrahedra, one
/// connected part, and a manifold boundary: two triangles at each edge, one fan of triangles at each vertex.
/// Throws std::runtime_error("WHERE: element N: reason; ...") with 0-based element numbers; all faults are
/// counted, the first few are listed. A stage is only reached when the stages before it found nothing:
/// numbers and coordinates, then shapes and duplicates, then connection and boundary.
void check_tet_mesh(const TetMesh& mesh, const std::string& where);

}  // namespace palpate
