#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// A state of a body as files show it. All lists of points run over the same points.
struct SolutionTable {
  std::vector<int> node;                       ///< 0-based number in the mesh file
  std::vector<Eigen::Vector3d> position;       ///< [m] at rest
  std::vector<Eigen::Vector3d> displacement;   ///< [m]
  std::vector<Eigen::Vector3d> force;          ///< [N] on the tissue; empty: not told
  std::vector<Eigen::Vector3d> velocity;       ///< [m/s]; empty: not told
  std::vector<char> listed;                    ///< which points a CSV lists; empty: all
  std::vector<std::array<int, 4>> tetrahedra;  ///< points; either these
  std::vector<std::array<int, 3>> triangles;   ///< or these
  std::vector<Eigen::Matrix3d> stress;         ///< [Pa] per tetrahedron; empty: not told
};

/// "node,x,y,z,ux,uy,uz" and fx,fy,fz or vx,vy,vz where they are told.
std::string csv_columns(const SolutionTable& table);
/// One line a point, each begun with `before`, with 17 significant digits.
std::string csv_lines(const SolutionTable& table, std::string_view before = {});

/// Those columns and lines. Throws std::runtime_error if it cannot be written.
void write_csv(const SolutionTable& table, const std::filesystem::path& file);

/// VTK's XML unstructured grid (ASCII) at rest, for ParaView, with point data `displacement`, `force`, `velocity`,
/// `node`, and cell data `stress` (xx, yy, zz, xy, yz, xz) [Pa] and `von_mises` [Pa] where they are told.
void write_vtu(const SolutionTable& table, const std::filesystem::path& file);

}  // namespace palpate
