#include "common/models/catheter/check_duct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "common/mesh/shell_quality.hpp"

namespace palpate {

void check_duct(const CatheterSpec& wire, const ShellSpec& duct, const ShellMesh& mesh) {
  const auto mouths = boundary_loops(mesh.triangles).size();
  if (mouths != 2)
    throw std::runtime_error(
        fmt::format("{}: a tube with two open ends is expected, into which the catheter '{}' is led, and "
                    "the surface has {} boundary line{}{}",
                    duct.mesh.string(), wire.name, mouths, mouths == 1 ? "" : "s",
                    mouths > 2 ? ": is there a hole in the wall?" : ""));
  const double lumen = lumen_radius(mesh) - 0.5 * duct.shell.thickness;
  if (wire.catheter.radius >= lumen)
    throw std::runtime_error(
        fmt::format("{}: the catheter '{}' is {:.4g} mm wide, and the duct '{}' is {:.4g} mm wide inside "
                    "at its narrowest",
                    duct.mesh.string(), wire.name, 2e3 * wire.catheter.radius, duct.name, 2e3 * std::max(0.0, lumen)));
}

void check_guest(const CatheterSpec& body, const ShellSpec& wall, const ShellMesh& mesh) {
  if (body.catheter.inside == wall.name) check_duct(body, wall, mesh);
}

}  // namespace palpate
