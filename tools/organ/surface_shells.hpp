#pragma once
#include <vector>

#include "common/mesh/tet_mesh.hpp"
#include "tools/organ/finding.hpp"

namespace palpate {

/// [m] Of the box around all triangles.
double diagonal(const TriangleMesh& mesh);

/// [m] Likewise of the shell with the largest area alone.
double diagonal_of_largest_shell(const TriangleMesh& mesh);

/// Triangles that hang together through edges, ascending in each shell.
std::vector<std::vector<int>> shells_of(const TriangleMesh& mesh);

/// The rims of an oriented surface's holes, each a loop of nodes in the sense in which a patch is wound that closes it.
std::vector<std::vector<int>> rims_of(const TriangleMesh& mesh);

/// [m] The largest distance between two of a rim's nodes; of a rim of more than a thousand as far as going from one to
/// the farthest of all finds it.
double across(const TriangleMesh& mesh, const std::vector<int>& rim);

double surface_area(const TriangleMesh& mesh);  ///< [m^2]

/// [m^3] that a closed surface encloses; negative where its normals point inward.
double enclosed_volume(const TriangleMesh& mesh);

/// Leaves out open shells beside the one with the largest area whose holes are larger than `max_hole` [m], and
/// notes each.
void leave_open_shells_out(TriangleMesh& mesh, double max_hole, std::vector<Finding>& findings);

/// Of closed shells keeps the one that encloses most, its normals outward, with the cavities in it and what crosses it;
/// the others are noted, and that it was inside out. Which shell lies in which says what it is, however it is wound:
/// one inside the largest alone is a cavity, one within a cavity a loose island, which is left out with what is in it.
void keep_largest_shell(TriangleMesh& mesh, std::vector<Finding>& findings);

}  // namespace palpate
