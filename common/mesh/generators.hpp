#pragma once
#include <array>
#include <vector>

#include "common/mesh/tet_mesh.hpp"

namespace palpate {

/// Structured block with `cells` cells along x, y, z between the corners `min` and `max` [m].
/// Each cell is cut into six equal tetrahedra around a space diagonal; neighbouring cells are mirror images,
/// so that every plane between two layers of cells is a plane of symmetry (with even cell counts: the
/// mid-planes too). Nodes are numbered with x fastest, then y, then z: (k*(ny+1) + j)*(nx+1) + i.
/// Groups of surface nodes: x0, x1, y0, y1, z0, z1 (the faces at min and max), bottom (z0), top (z1).
/// Throws std::runtime_error where a count or an extent is not positive.
TetMesh make_block(const Eigen::Vector3d& min, const Eigen::Vector3d& max, const std::array<int, 3>& cells);

/// The same with grid planes at the given ascending coordinates [m], at least two per axis.
TetMesh make_graded_block(const std::vector<double>& xs, const std::vector<double>& ys, const std::vector<double>& zs);

/// The block of make_block, nodes and groups alike, with five tetrahedra to a cell: one in the middle with a
/// third of the volume, and four at corners. Neighbouring cells are mirror images.
TetMesh make_block_of_five(const Eigen::Vector3d& min, const Eigen::Vector3d& max, const std::array<int, 3>& cells);

/// Ascending grid coordinates from `begin` to `end` [m] in `cells` steps; each step is `ratio` times the one
/// before it. ratio = 1: uniform.
std::vector<double> graded_axis(double begin, double end, int cells, double ratio);

/// Grid coordinates symmetric about the middle of [begin, end], finest there: `cells` (even) steps that grow
/// by `ratio` from the middle outwards.
std::vector<double> centred_axis(double begin, double end, int cells, double ratio);

/// Solid cylinder about the z axis from z = 0 to z = height [m]: `rings` rings of triangles around the axis
/// (ring k has 6k nodes), `layers` layers of prisms, three tetrahedra each: 18 rings^2 layers tetrahedra and
/// (1 + 3 rings (rings+1)) (layers+1) nodes, layer by layer from the bottom, from the axis outwards.
/// With an even number of layers the mid-height plane carries nodes and is a plane of symmetry.
/// Groups of surface nodes: bottom, top, side (rims belong to both).
TetMesh make_cylinder(double radius, double height, int rings, int layers);

}  // namespace palpate
