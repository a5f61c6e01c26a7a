// What a check says of a catheter.
#include "common/models/check/check.hpp"

#include <fmt/format.h>

#include <numbers>
#include <stdexcept>

#include "common/mesh/shell_file.hpp"
#include "common/models/catheter/catheter_body.hpp"
#include "common/models/catheter/check_duct.hpp"

namespace palpate {
namespace {

/// It must not stick in the wall of its duct at rest.
void check_rest(const CatheterSpec& body, const CheckSettings& settings) {
  const ShellSpec* duct = settings.find_wall(body.catheter.inside);
  if (!duct) return;
  const ShellMesh mesh = load_shell_mesh(duct->mesh, duct->scale);
  settings.check_guests(*duct, mesh);
  const double reach = body.catheter.radius + 0.5 * duct->shell.thickness;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto closest = closest_points(Segment{body.catheter.tail, body.catheter.tip},
                                        Triangle{mesh.nodes[a], mesh.nodes[b], mesh.nodes[c]});
    if (closest.squared_distance < reach * reach)
      throw std::runtime_error(fmt::format("body '{}': at rest it sticks in the wall of '{}'", body.name, duct->name));
  }
}

/// Steps in a haptic one.
int substeps_of(const CatheterSpec& body, const CheckSettings& settings) try {
  return CatheterBody({body.catheter, body.material.young, body.material.density, settings.dt}, nullptr).substeps();
} catch (const std::exception& error) {
  throw std::runtime_error(fmt::format("body '{}': {}", body.name, error.what()));
}

void add_warnings(const CatheterSpec& body, int substeps, CheckReport& report) {
  const Catheter& catheter = body.catheter;
  const double spacing = (catheter.tip - catheter.tail).norm() / (catheter.particles - 1);
  if (spacing > 2 * catheter.radius)
    report.warnings.push_back(
        fmt::format("catheter '{}' has its particles {:.3g} m apart, more than it is thick, {:.3g} m: a wall "
                    "can pass between them",
                    body.name, spacing, 2 * catheter.radius));
  if (catheter.integrator != ChainIntegrator::implicit && substeps > 8)
    report.warnings.push_back(
        fmt::format("catheter '{}' is stiff: {} needs {} steps in each haptic one; implicit takes one", body.name,
                    word_of(catheter.integrator), substeps));
}

}  // namespace

void check(const CatheterSpec& body, const CheckSettings& settings, CheckReport& report) {
  const Catheter& catheter = body.catheter;
  const Chain chain(catheter, body.material.young, body.material.density);
  const double area = std::numbers::pi * catheter.radius * catheter.radius;
  report.say(fmt::format("body '{}': {} particles {:.4g} m apart, {:.4g} m long, {} m thick; model {}", body.name,
                         catheter.particles, chain.spacing(), (catheter.tip - catheter.tail).norm(),
                         2 * catheter.radius, CatheterSpec::kKind));
  if (!catheter.inside.empty()) report.say(fmt::format("  led into '{}'", catheter.inside));
  if (catheter.sleeve > 0) report.say(fmt::format("  sleeve: {} m from its tail", catheter.sleeve));
  report.say(fmt::format("  material: young {} Pa, density {} kg/m3; bending stiffness {:.4g} N m2",
                         body.material.young, body.material.density,
                         body.material.young * area * catheter.radius * catheter.radius / 4));
  const int substeps = substeps_of(body, settings);
  report.say(fmt::format(
      "  springs: frequencies up to {:.4g} Hz; {}, {} step{} in each haptic one; damping {} 1/s, "
      "gravity {} {} {} m/s2",
      chain.frequency_bound() / (2 * std::numbers::pi), word_of(catheter.integrator), substeps,
      substeps == 1 ? "" : "s", catheter.damping, catheter.gravity.x(), catheter.gravity.y(), catheter.gravity.z()));
  check_rest(body, settings);
  add_warnings(body, substeps, report);
  report.meets = [catheter](const Segment& axis, double radius) {
    const double reach = radius + catheter.radius;
    return closest_points(axis, Segment{catheter.tail, catheter.tip}).squared_distance < reach * reach;
  };
}

}  // namespace palpate
