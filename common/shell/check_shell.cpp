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

constexpr double kThinnest = 1e-4;  // of the mean edge: bending is then 1e-8 of stretching, whose rounding hides it

double mean_edge(const ShellMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) sum += (mesh.nodes[t[c]] - mesh.nodes[t[(c + 1) % 3]]).norm();
  return sum / (3 * static_cast<double>(mesh.triangles.size()));
}

void refuse_film(const ShellSpec& body, const ShellMesh& mesh, const std::string& where) {
  const double edge = mean_edge(mesh), share = body.shell.thickness / edge;
  if (share < kThinnest)
    throw std::runtime_error(
        fmt::format("{}: the wall is {:.4g} mm thick, {:.2g} of the mean edge {:.4g} mm of its mesh: below {:g} its "
                    "bending is lost in the rounding of its stretching; a finer mesh bears a thinner wall",
                    where, 1e3 * body.shell.thickness, share, 1e3 * edge, kThinnest));
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
  refuse_film(body, mesh, where);
  if (body.shell.modes > dofs.translations())
    throw std::runtime_error(
        fmt::format("{}: it asks for {} modes, and its mesh has {} free displacements: ask for fewer", where,
                    body.shell.modes, dofs.translations()));
}

}  // namespace palpate
