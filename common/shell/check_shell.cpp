#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/mesh/shell_quality.hpp"
#include "common/shell/boundary_conditions.hpp"

namespace palpate {
namespace {

double half_extent(const ShellMesh& mesh) {
  Eigen::Vector3d low = mesh.nodes[mesh.triangles[0][0]], high = low;
  for (const auto& t : mesh.triangles)
    for (int n : t) {
      low = low.cwiseMin(mesh.nodes[n]);
      high = high.cwiseMax(mesh.nodes[n]);
    }
  return 0.5 * (high - low).maxCoeff();
}

}  // namespace

void check_shell(const ShellSpec& body, const ShellMesh& mesh, const ShellDofs& dofs, const std::string& where) {
  const bool tube = boundary_loops(mesh.triangles).size() == 2;
  const double radius = tube ? lumen_radius(mesh) : half_extent(mesh);
  if (body.shell.thickness > radius)
    throw std::runtime_error(
        fmt::format("{}: the wall is {:.4g} mm thick, and the {} of its middle surface is {:.4g} mm: a thin "
                    "wall is thinner than that",
                    where, 1e3 * body.shell.thickness, tube ? "radius" : "half extent", 1e3 * radius));
  if (body.shell.modes > dofs.translations())
    throw std::runtime_error(
        fmt::format("{}: it asks for {} modes, and its mesh has {} free displacements: ask for fewer", where,
                    body.shell.modes, dofs.translations()));
}

}  // namespace palpate
