#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/mesh/shell_quality.hpp"
#include "common/shell/fixation.hpp"

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

void check_shell(const Body& body, const ShellMesh& mesh, const ShellDofs& dofs, const std::string& where) {
  const bool tube = boundary_loops(mesh.triangles).size() == 2;
  const double radius = tube ? lumen_radius(mesh) : half_extent(mesh);
  if (body.shell->thickness > radius)
    throw std::runtime_error(
        fmt::format("{}: the wall is {:.4g} mm thick, and the {} of its middle surface is {:.4g} mm: a thin "
                    "wall is thinner than that",
                    where, 1e3 * body.shell->thickness, tube ? "radius" : "half extent", 1e3 * radius));
  if (body.shell->modes > dofs.translations())
    throw std::runtime_error(
        fmt::format("{}: it asks for {} modes, and its mesh has {} free displacements: ask for fewer", where,
                    body.shell->modes, dofs.translations()));
}

void check_duct(const Scene& scene, const Body& shell, const ShellMesh& mesh) {
  for (const Body& body : scene.bodies) {
    if (!body.catheter || body.catheter->inside != shell.name) continue;
    const auto mouths = boundary_loops(mesh.triangles).size();
    if (mouths != 2)
      throw std::runtime_error(
          fmt::format("{}: a tube with two open ends is expected, into which the catheter '{}' is led, and "
                      "the surface has {} boundary "
                      "line{}{}",
                      shell.mesh.string(), body.name, mouths, mouths == 1 ? "" : "s",
                      mouths > 2 ? ": is there a hole in the wall?" : ""));
    const double lumen = lumen_radius(mesh) - 0.5 * shell.shell->thickness;
    if (body.catheter->radius >= lumen)
      throw std::runtime_error(fmt::format(
          "{}: the catheter '{}' is {:.4g} mm wide, and the duct '{}' is {:.4g} mm wide inside "
          "at its narrowest",
          shell.mesh.string(), body.name, 2e3 * body.catheter->radius, shell.name, 2e3 * std::max(0.0, lumen)));
  }
}

}  // namespace palpate
