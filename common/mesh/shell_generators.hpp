#pragma once
#include <functional>

#include "common/mesh/shell_mesh.hpp"

namespace palpate {

/// A tube along a curve: `centre` [m] and `radius` [m] are functions of 0 (the first end) .. 1. `around`
/// nodes on each of `along` + 1 rings; node i * around + j is number j of ring i. Rings stand across the
/// curve and are not twisted against each other; each cell has two triangles, with diagonals that alternate
/// like a chessboard. Groups `end0` and `end1` hold the nodes of the first and last ring. Triangles look
/// outward. Throws std::runtime_error where a count is too small (3 around, 1 along) or a radius is not
/// positive.
ShellMesh make_tube(const std::function<Eigen::Vector3d(double)>& centre, const std::function<double(double)>& radius,
                    int around, int along);

/// A straight round tube about the z axis from z = 0 to `length` [m]; node 0 lies at x = radius.
ShellMesh make_tube(double radius, double length, int around, int along);

}  // namespace palpate
