#include "common/models/check/surface_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/archive/compliance.hpp"
#include "common/contact/patch/near_field.hpp"
#include "common/contact/patch/patch_parts.hpp"
#include "common/contact/tool_contacts.hpp"
#include "common/contact/touch_surface.hpp"
#include "common/geometry/buckets.hpp"
#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

/// Free degrees of freedom of the touchable and of the other visible nodes.
struct DofCounts {
  std::size_t touchable = 0, other = 0;
};

DofCounts count_dofs(const SurfaceMap& surface) {
  DofCounts counts;
  for (int n = 0; n < surface.size(); ++n)
    (n < surface.touchable ? counts.touchable : counts.other) += std::ranges::count(surface.fixed[n], false);
  return counts;
}

}  // namespace

std::string describe(const Selector& where, const char* list) {
  if (!where.group.empty()) return fmt::format("group '{}'", where.group);
  return where.box ? "a box" : fmt::format("a list of {}", list);
}

std::string letters(const std::array<bool, 3>& axes) {
  std::string held;
  for (int axis = 0; axis < 3; ++axis)
    if (axes[axis]) held += "xyz"[axis];
  return held;
}

std::vector<MemoryPart> compliance_memory(const CheckSettings& settings, const SurfaceMap& surface,
                                          std::size_t elements, int fields, std::size_t compressed) {
  const DofCounts dofs = count_dofs(surface);
  const std::size_t nodes = surface.position.size(), triangles = surface.triangles.size();
  const std::size_t triangle_entries = dofs.touchable * (dofs.touchable + 1) / 2;
  const std::size_t numbering = nodes * (3 * sizeof(double) + 4 * sizeof(int)) + triangles * 3 * sizeof(int) +
                                2 * sizeof(int) * (dofs.touchable + dofs.other) + elements * sizeof(int);
  const double size = settings.contact.bucket_size > 0 ? settings.contact.bucket_size : 2 * mean_edge(surface);
  const Buckets buckets(surface.position, surface.triangles, size);
  const auto cells = buckets.cells();

  std::vector<MemoryPart> parts;
  const auto add = [&](const char* owner, std::string what, std::size_t bytes) {
    parts.push_back({owner, std::move(what), bytes});
  };
  const auto add_compliance = [&](const char* owner, std::string dense, std::size_t bytes) {
    add(owner, compressed ? "compressed compliance, single precision" : std::move(dense),
        compressed ? compressed : bytes);
  };
  add_compliance("disk", "archive: compliance among touchable dofs", sizeof(double) * triangle_entries);
  if (dofs.other > 0 && !compressed)
    add("disk", "archive: compliance of the rest of the surface", sizeof(double) * dofs.other * dofs.touchable);
  add("disk", "archive: surface and numbering", numbering);
  if (!settings.tools.empty()) {
    add_compliance("haptic_node", "compliance, double precision",
                   Compliance<double>::bytes_of(surface.touchable, surface.touchable));
    add("haptic_node", fmt::format("buckets of {:.3g} m, {} x {} x {}", size, cells[0], cells[1], cells[2]),
        buckets.bytes());
    add("haptic_node", "surface at rest, now and one step ago",
        3 * nodes * sizeof(Eigen::Vector3d) + triangles * (6 * sizeof(int) + sizeof(double)));
  }
  add_compliance("render_node --deform", "compliance, single precision",
                 Compliance<float>::bytes_of(surface.size(), surface.touchable));
  add("render_node --deform", "visible surface",
      nodes * (fields * sizeof(Eigen::Vector3f) + sizeof(Eigen::Vector3d)) + triangles * 3 * sizeof(int));
  return parts;
}

void say_touched_by_mesh(const CheckSettings& settings, CheckReport& report) {
  if (settings.contact.rule == ContactRule::patch && !settings.tools.empty())
    report.say("  touch: by its mesh, as under rule \"barycentric\": patches are for solid bodies");
}

void say_patches(const CheckSettings& settings, const std::string& body, bool shafts, CheckReport& report) {
  if (settings.contact.rule != ContactRule::patch) return;
  for (const Tool& tool : settings.tools) {
    const bool ball = abilities_of(tool).ball.has_value();
    if (shafts)
      report.say(
          ball ? fmt::format("  touch: tip and shaft of '{}' press '{}', each by a patch of its own", tool.name, body)
               : fmt::format("  touch: the shaft of '{}' presses '{}' by a patch of its own, its jaws by the mesh",
                             tool.name, body));
    else
      report.say(
          ball ? fmt::format("  touch: the tip of '{}' presses '{}' by a patch of its own, its shaft by the mesh",
                             tool.name, body)
               : fmt::format("  touch: '{}' has no ball at its tip and touches '{}' by the mesh", tool.name, body));
  }
}

void add_near_field(const char* owner, const CheckSettings& settings, const SurfaceMap& surface, bool shafts,
                    CheckReport& report) {
  double radius = 0;
  for (const PatchPart& part : patch_parts(settings.tools, shafts))
    radius = std::max(radius, std::min(part.radius, widest_patch(surface)));
  if (settings.contact.rule != ContactRule::patch || radius == 0) return;
  report.memory.push_back({owner, "near field of patches", NearField::bytes_of(surface, radius)});
}

std::vector<std::string> size_warnings(const CheckSettings& settings, const std::string& body,
                                       const SurfaceMap& surface, bool patches) {
  std::vector<std::string> warnings;
  Eigen::Vector3d low = surface.position[0], high = low;
  for (const Eigen::Vector3d& p : surface.position) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double h = mean_edge(surface), across = (high - low).maxCoeff();
  for (const Tool& tool : settings.tools) {
    const EndAbilities end = abilities_of(tool);
    const double radius = end.radius;
    const auto warn = [&](const std::string& than, const char* so) {
      warnings.push_back(fmt::format("tool '{}' has {} of {:.3g} m, {} of body '{}': {}", tool.name, end.radius_of,
                                     radius, than, body, so));
    };
    const bool by_mesh = !patches || settings.contact.rule != ContactRule::patch || !end.ball;
    if (radius > across)
      warn(fmt::format("more than the {:.3g} m across", across), "it presses as a flat plate; is it in metres?");
    else if (by_mesh && radius < h)
      warn(fmt::format("less than the mean edge {:.3g} m", h), "the force is the mesh's, not the tissue's");
    else if (by_mesh && radius < 2 * h)
      warn(fmt::format("less than twice the mean edge {:.3g} m", h), "the force still depends on the mesh");
  }
  if (across > kMaxBody || across < kMinBody)
    warnings.push_back(fmt::format("body '{}' is {:.3g} m across: is its scale right?", body, across));
  return warnings;
}

std::function<bool(const Segment&, double)> meets_surface(const SurfaceMap& map, bool solid, double thickness) {
  const auto surface = std::make_shared<const TouchSurface>(map, 2 * mean_edge(map));
  return [=](const Segment& axis, double radius) {
    if (solid && (surface->encloses(axis.start) || surface->encloses(axis.end))) return true;
    const double reach = radius + 0.5 * thickness;
    for (int t = 0; t < surface->triangle_count(); ++t)
      if (closest_points(axis, surface->corners(t)).squared_distance < reach * reach) return true;
    return false;
  };
}

}  // namespace palpate
