#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "common/mesh/shell_mesh.hpp"

namespace palpate {

/// A triangle whose shape (see triangle_shape) is below this counts as degenerate.
inline constexpr double kDegenerateTriangle = 1e-4;

/// Shape of a triangle: 4 sqrt(3) area / (sum of squared edge lengths). 1 for an equilateral one, 0 for a
/// flat one or one without edges.
double triangle_shape(const ShellMesh& mesh, const std::array<int, 3>& t);

/// Turns the triangles alike, as most of each connected part are in the file; then outward where the shell,
/// its mouths closed by fans of triangles, encloses more than a thousandth of its area^(3/2): a tube, a cup,
/// a closed shell. Flat shells stay as they are. Throws std::runtime_error("WHERE: reason") on a one-sided
/// surface.
void orient_shell(ShellMesh& mesh, const std::string& where);

/// Refuses a mesh that cannot be computed with. Checked: node numbers in range, coordinates finite; no
/// triangle degenerate or present twice; no edge shared by more than two triangles, triangles oriented alike,
/// one connected part, one fan of triangles at each node. Throws std::runtime_error("WHERE: triangle N:
/// reason; ...") with 0-based numbers; all faults are counted, the first few are listed. A stage is only
/// reached when the stages before it found nothing.
void check_shell_mesh(const ShellMesh& mesh, const std::string& where);

/// Boundary loops of a surface: the nodes of each in the direction in which the triangles run along it, each
/// loop once, its least node first; loops ascend in that node. Expects a surface that check_shell_mesh() lets
/// pass.
std::vector<std::vector<int>> boundary_loops(std::span<const std::array<int, 3>> triangles);

/// Volume [m^3] inside a shell whose mouths are closed by fans about their centroids; positive where the
/// triangles look outward.
double enclosed_volume(const ShellMesh& mesh);

/// A section across a tube.
struct TubeSection {
  Eigen::Vector3d centre;  ///< [m] centroid of the section's line, by length
  double radius = 0;       ///< [m] least distance from the centre to that line
};

/// Sections of a tube (a shell with two mouths) from the first of boundary_loops() to the second, both mouths
/// included. They are level lines of the harmonic function that is 0 at the first mouth and 1 at the second
/// (each node the mean of its neighbours), at `count` + 1 even levels. Throws std::runtime_error if the shell
/// has not two mouths.
std::vector<TubeSection> tube_sections(const ShellMesh& mesh, int count = 32);

/// The least radius [m] of the tube's sections: how far the centre line, through the sections' centres, keeps
/// from the mesh. Half a wall's thickness less, this is the widest straight-through radius.
double lumen_radius(const ShellMesh& mesh);

}  // namespace palpate
