// What a check says of a quasi-static body.
#include "common/models/solid/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <stdexcept>

#include "common/contact/creep.hpp"
#include "common/fem/fine_space.hpp"
#include "common/fem/specimen.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/check/loads_check.hpp"
#include "common/models/quasi_static/compress.hpp"
#include "common/models/quasi_static/nonlinear.hpp"
#include "common/models/quasi_static/precompute.hpp"
#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

constexpr double kLikeBall = 0.25;  // by which a tip may differ from the ball that pressed

bool has_linear_displacement(const std::optional<Offline>& offline) {
  return !offline || (offline->element == FiniteElement::p1 && offline->formulation == Formulation::displacement);
}

/// What the tensors come from, and why where the scene does not say.
void say_offline(const QuasiStaticSpec& body, const TetMesh& mesh, int surface_nodes, CheckReport& report) try {
  const Offline offline = offline_of(body, surface_nodes);
  const auto space = make_fine_space(mesh, offline);
  const std::string why = why_offline(body, surface_nodes);
  report.say(fmt::format("  offline: tensors from {} {} tetrahedra with {} nodes, {}{}", space.elements.size(),
                         space.per_element == 4 ? "linear" : "quadratic", space.nodes.size(),
                         offline.formulation == Formulation::locking_free ? "locking-free" : "displacement formulation",
                         why.empty() ? "" : "; chosen, " + why));
} catch (const std::runtime_error& error) {
  throw std::runtime_error(fmt::format("body '{}': [body.offline]: {}", body.name, error.what()));
}

/// [bytes] That compressed tensors will take; 0 where they stay dense.
std::size_t say_form(const SurfaceMap& surface, CheckReport& report) {
  if (form_of(surface.touchable) == TensorForm::dense) return 0;
  report.say(
      fmt::format("  tensors: compressed, since more than {} nodes can be touched: near blocks dense, far ones "
                  "of low rank",
                  kMaxDense));
  return compressed_bytes(surface);
}

std::string say_law(const MeasuredLaw& law, const QuasiStaticSpec& body, const CheckSettings&) {
  Archive slopes;
  if (const auto specimen = load_specimen(body)) {
    const auto pressed = press_specimen(*specimen, body.material);
    slopes.specimen_force_slope = pressed.force;
    slopes.specimen_radial_slope = pressed.radial;
  }
  const QuasiNonlinear curves = make_nonlinear(body, slopes).at(Eigen::Vector3d::Zero());
  return fmt::format(
      "degree {}, {} ends; fitted up to a linear force of {:.3g} N and a linear radial displacement of "
      "{:.3g} m",
      law.degree, law.specimen_mesh.empty() ? "sliding" : "stuck", curves.force_curve().end(),
      curves.radial_curve().end());
}

std::string say_law(const NeoHookeanLaw& law, const QuasiStaticSpec&, const CheckSettings& settings) {
  const auto archive = settings.stored(ArchivePart::header);
  if (!archive) return fmt::format("to be fitted to presses at {} places", law.places);
  const auto [least, most] = std::ranges::minmax(archive->presses, {}, &PressedPlace::depth);
  return fmt::format("fitted to presses at {} places, to depths of {:.3g} to {:.3g} m", archive->presses.size(),
                     least.depth, most.depth);
}

void say_nonlinear(const QuasiStaticSpec& body, const CheckSettings& settings, CheckReport& report) {
  if (!body.nonlinear) {
    report.left_out.emplace_back("no quasi non-linear correction");
    return;
  }
  report.say("  quasi non-linear correction: " +
             std::visit([&](const auto& law) { return say_law(law, body, settings); }, body.nonlinear->law));
}

/// Forces of one ball say little of another's.
void warn_of_ball(const QuasiStaticSpec& body, const CheckSettings& settings, CheckReport& report) {
  const auto* law = law_of<NeoHookeanLaw>(body.nonlinear);
  if (!law) return;
  for (const Tool& tool : settings.tools) {
    const double radius = abilities_of(tool).radius;
    if (std::abs(radius / law->ball_radius - 1) > kLikeBall)
      report.warnings.push_back(fmt::format(
          "tool '{}' has {} of {:.3g} m, and the correction of body '{}' is of presses with a ball of {:.3g} "
          "m: give [body.nonlinear] that ball_radius",
          tool.name, abilities_of(tool).radius_of, radius, body.name, law->ball_radius));
  }
}

void say_relaxation(const QuasiStaticSpec& body, CheckReport& report) {
  if (!body.relaxation) return;
  std::vector<double> times;
  double left = body.material.young;
  for (const double share : body.relaxation->shares) left -= share * body.material.young;
  for (const CreepTerm& term : creep_terms(*body.relaxation)) times.push_back(term.time);
  report.say(fmt::format(
      "  relaxation: young falls from {:.4g} Pa to {:.4g} Pa; under a force that stays it creeps with {:.3g} s",
      body.material.young, left, fmt::join(times, ", ")));
}

/// [m^2] Of what can be touched, and of that what lies on another material than the body's own.
struct TouchedArea {
  double all = 0, other = 0;
};

std::array<int, 3> ascending(std::array<int, 3> nodes) {
  std::ranges::sort(nodes);
  return nodes;
}

bool feels_as(const Material& a, const Material& b) {
  return a.young == b.young && a.poisson == b.poisson;
}

TouchedArea touched_area(const CheckedSolid& solid, const Material& own) {
  const SurfaceMap& surface = solid.surface;
  std::map<std::array<int, 3>, double> area;  // of the triangles that can be touched, by their mesh nodes
  TouchedArea sum;
  for (const auto& t : surface.triangles) {
    if (std::ranges::min(t) >= surface.touchable) continue;
    const auto& p = surface.position;
    const double size = 0.5 * (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm();
    area[ascending({surface.node_number[t[0]], surface.node_number[t[1]], surface.node_number[t[2]]})] = size;
    sum.all += size;
  }
  for (std::size_t e = 0; e < solid.materials.of_element.size(); ++e) {
    if (feels_as(solid.materials.at(static_cast<int>(e)), own)) continue;
    const auto& n = solid.mesh.tetrahedra[e];
    for (const auto& [i, j, k] : {std::array{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}})
      if (const auto found = area.find(ascending({n[i], n[j], n[k]})); found != area.end()) sum.other += found->second;
  }
  return sum;
}

/// A patch takes the tissue near it to be of the body's own material.
void warn_of_regions(const QuasiStaticSpec& body, const CheckedSolid& solid, const CheckSettings& settings,
                     CheckReport& report) {
  if (settings.contact.rule != ContactRule::patch || settings.tools.empty()) return;
  const TouchedArea area = touched_area(solid, body.material);
  if (area.other == 0) return;
  report.warnings.push_back(fmt::format(
      "{:.0f} % of what can be touched of body '{}' is of other materials than its own: a patch feels the tissue next "
      "to it with {:.4g} Pa and poisson {:.3g} there too; rule \"barycentric\" takes each element's own",
      100 * area.other / area.all, body.name, body.material.young, body.material.poisson));
}

/// What the haptic node keeps of the past: its field, of each retardation.
MemoryPart memory_of_past(const QuasiStaticSpec& body, const SurfaceMap& surface) {
  const std::size_t terms = body.relaxation->times.size();
  return {"haptic_node", "what is left of past forces", terms * 3 * sizeof(double) * surface.touchable};
}

}  // namespace

void check(const QuasiStaticSpec& body, const CheckSettings& settings, CheckReport& report) {
  const CheckedSolid solid = load_solid(body);
  check_solid(body, QuasiStaticSpec::kKind, solid, settings, report);
  resting_loads(body, solid.mesh);  // which it refuses
  say_loads(body, body.gravity, settings, report);
  say_offline(body, solid.mesh, solid.surface.size(), report);
  say_patches(settings, body.name, !body.relaxation, report);
  say_nonlinear(body, settings, report);
  say_relaxation(body, report);
  const int fields = body.nonlinear ? 5 : 3;  // position, displacement, normal; the linear sum and one tool's share
  report.memory = compliance_memory(settings, solid.surface, solid.materials.of_element.size(), fields,
                                    say_form(solid.surface, report));
  add_near_field("haptic_node", settings, solid.surface, !body.relaxation, report);
  if (!body.relaxation) add_near_field("render_node --deform", settings, solid.surface, false, report);
  if (body.relaxation && !settings.tools.empty()) report.memory.push_back(memory_of_past(body, solid.surface));
  QuasiStaticSpec chosen = body;
  chosen.offline = offline_of(body, solid.surface.size());
  std::ranges::copy(locking_warnings(chosen), std::back_inserter(report.warnings));
  warn_of_ball(body, settings, report);
  warn_of_regions(body, solid, settings, report);
  std::ranges::copy(material_warnings(body), std::back_inserter(report.warnings));
}

std::vector<std::string> locking_warnings(const QuasiStaticSpec& body) {
  if (!has_linear_displacement(body.offline)) return {};
  return locking_warnings(body, "give it a [body.offline] with element = \"p2\" and formulation = \"locking_free\"");
}

}  // namespace palpate
