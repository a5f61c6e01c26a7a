#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <vector>

namespace palpate {

/// A static state as files show it. All lists run over the same points.
struct SolutionTable {
  std::vector<int> node;                       ///< 0-based number in the mesh file
  std::vector<Eigen::Vector3d> position;       ///< [m] at rest
  std::vector<Eigen::Vector3d> displacement;   ///< [m]
  std::vector<Eigen::Vector3d> force;          ///< [N] on the tissue
  std::vector<char> listed;                    ///< which points a CSV lists; empty: all
  std::vector<std::array<int, 4>> tetrahedra;  ///< points; either these
  std::vector<std::array<int, 3>> triangles;   ///< or these
};

/// Columns node,x,y,z,ux,uy,uz,fx,fy,fz with 17 significant digits. Throws std::runtime_error if it cannot be
/// written.
void write_csv(const SolutionTable& table, const std::filesystem::path& file);

/// VTK's XML unstructured grid (ASCII) at rest, with point data `displacement`, `force`, `node`; for
/// ParaView.
void write_vtu(const SolutionTable& table, const std::filesystem::path& file);

}  // namespace palpate
