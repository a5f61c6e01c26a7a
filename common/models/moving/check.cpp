#include "common/models/solid/check.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <memory>
#include <set>

#include "common/contact/cut_surface.hpp"
#include "common/contact/patch/patch_parts.hpp"
#include "common/contact/tool_contacts.hpp"
#include "common/dynamics/condensed_part.hpp"
#include "common/mesh/cut_mesh.hpp"
#include "common/models/check/loads_check.hpp"
#include "common/models/moving/predict.hpp"
#include "common/models/moving/static_problem.hpp"
#include "common/models/moving_kind.hpp"

namespace palpate {
namespace {

// Averaged strain has been found stable below both (docs/stability.md): [edges], [1].
constexpr double kWideTip = 1.5, kRough = 0.3;

std::size_t edge_count(const Archive& archive) {
  std::set<std::array<int, 2>> edges;
  for (const auto& t : archive.tetrahedra)
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) edges.insert({std::min(t[a], t[b]), std::max(t[a], t[b])});
  return edges.size();
}

std::size_t moving_nodes(const Archive& archive) {
  std::set<int> nodes;
  for (const auto& t : archive.tetrahedra) nodes.insert(t.begin(), t.end());
  return nodes.size();
}

void say_extent(const MovingKind& kind, const TetMesh& mesh, const Archive& archive, CheckReport& report) {
  const std::size_t moving = archive.tetrahedra.size();
  std::string extent =
      fmt::format("  moving: {} nodes, {} tetrahedra, {} edges", moving_nodes(archive), moving, edge_count(archive));
  if (archive.condensed) {
    const double whole = static_cast<double>(mesh.tetrahedra.size() + (kind.own_mesh ? moving : 0));
    extent += fmt::format(", {:.1f} % of the tetrahedra; joined to the quasi-static part at {} nodes",
                          100 * static_cast<double>(moving) / whole, archive.condensed->connection.size());
    if (kind.own_mesh) extent += fmt::format(", gap at rest {:.3g} m", archive.condensed->max_gap);
  }
  report.say(extent);
}

std::unique_ptr<CondensedPart> make_rest(const MovingSpec& body, const Archive& archive, double friction) {
  if (!archive.condensed) return nullptr;
  return std::make_unique<CondensedPart>(archive, friction, body.dynamic.precision == Precision::float32);
}

void predict(const MovingSpec& body, const MovingKind& kind, const CheckSettings& settings, const CheckedSolid& solid,
             const Archive& archive, CheckReport& report) {
  const auto organ = make_moving_organ(body, archive, {settings.contact, settings.tools, settings.dt}, kind.make_model);
  say_steps(body, *organ, archive, settings, report);
  const int steps = organ->steps_in(settings.dt, true);
  if (!settings.tools.empty()) say_tried_contact(body, kind, settings, mean_edge(archive.surface), steps, report);
  if (kind.own_mesh) return;
  if (archive.condensed)
    say_sag(body, {solid.mesh, solid.materials, solid.dofs}, report);
  else
    say_sag(body, moving_problem(body, solid.mesh), report);
}

/// Bytes that the process has from its heap.
std::size_t heap_in_use() {
  const auto heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

/// What a dynamic body takes; the deformation node's parts are built here and measured.
std::vector<MemoryPart> memory(const MovingSpec& body, const MovingKind& kind, const CheckSettings& settings,
                               const Archive& archive) {
  std::vector<MemoryPart> parts;
  const auto add = [&](const char* owner, const char* what, std::size_t bytes) {
    parts.push_back({owner, what, bytes});
  };
  const std::size_t nodes = archive.surface.size(), triangles = archive.surface.triangles.size();
  const std::size_t tetrahedra = archive.tetrahedra.size();
  add("disk", "archive: tetrahedra, surface and numbering",
      nodes * (3 * sizeof(double) + 4 * sizeof(int)) + 3 * triangles * sizeof(int) + 4 * tetrahedra * sizeof(int));
  if (!archive.moving_compliance.empty())
    add("disk", "archive: compliance at rest", sizeof(double) * archive.moving_compliance.size());
  if (archive.condensed) {
    const CondensedTensors& h = *archive.condensed;
    add("disk", "archive: tensors of the connection nodes",
        sizeof(double) * (h.stiffness.size() + h.follow.size() + h.reaction.size() + h.sag.size()));
    add("disk", "archive: compliance of the quasi-static part",
        sizeof(double) * (archive.touchable_compliance.size() + archive.other_compliance.size()));
  }
  std::size_t before = heap_in_use();
  const auto measured = [&] {
    const std::size_t now = heap_in_use(), grown = now > before ? now - before : 0;
    before = now;
    return grown;
  };
  const ElasticMesh mesh = elastic_mesh(archive);
  measured();
  const auto model = kind.make_model(mesh);
  add("deform_node", "masses, tensors and motion", measured());
  const auto rest = make_rest(body, archive, settings.contact.friction);
  if (rest) add("deform_node", "quasi-static part", measured());
  const CutMesh topology(mesh.tetrahedra, mesh.nodes());
  const std::size_t of_topology = measured();
  add("deform_node", "topology that is cut", of_topology);
  const double size = settings.contact.bucket_size > 0 ? settings.contact.bucket_size : 2 * mean_edge(archive.surface);
  const CutSurface surface(topology, mesh.rest, size);
  add("deform_node", "surface and buckets", measured());
  add("render_node", "topology that is cut", of_topology);
  add("render_node", "visible surface", nodes * 2 * sizeof(Eigen::Vector3f) + 3 * triangles * sizeof(int));
  return parts;
}

void warn_of_averaged_strain(const MovingSpec& body, const CheckSettings& settings, double edge, CheckReport& report) {
  if (body.dynamic.element != TetElement::nodal_strain) return;
  double widest = 0;  // [m]
  for (const PatchPart& part : patch_parts(settings.tools, true)) widest = std::max(widest, part.radius);
  if (widest > kWideTip * edge)
    report.warnings.push_back(fmt::format(
        "body '{}': under a tip of {:.2g} edges, the force of elements of averaged strain is up to 11 % off "
        "what it is at rest",
        body.name, widest / edge));
  if (widest > 0 && settings.contact.friction > kRough)
    report.warnings.push_back(fmt::format(
        "body '{}': friction of {:g}: where it is near 1, the force of elements of averaged strain can swing",
        body.name, settings.contact.friction));
}

}  // namespace

void check_moving(const MovingSpec& body, const MovingKind& kind, const CheckSettings& settings, CheckReport& report) {
  const CheckedSolid solid = load_solid(body);
  const auto stored = settings.stored(ArchivePart::surface);
  const Progress silent;
  const Archive archive = stored ? *stored : kind.archive_job(silent)();
  check_solid(body, kind.name, solid, settings, report);
  say_extent(kind, solid.mesh, archive, report);
  const Dynamic& d = body.dynamic;
  report.say(fmt::format("  motion: {}, {} precision, damping {} 1/s, gravity {} {} {} m/s2{}", word_of(d.integrator),
                         word_of(d.precision), d.damping, d.gravity.x(), d.gravity.y(), d.gravity.z(),
                         d.corotational                          ? ", corotational"
                         : d.element == TetElement::nodal_strain ? ", strain averaged at the nodes"
                                                                 : ""));
  predict(body, kind, settings, solid, archive, report);
  say_patches(settings, body.name, true, report);
  const std::vector<std::string> of_material = material_warnings(body);
  report.warnings.insert(report.warnings.end(), of_material.begin(), of_material.end());
  if (body.tearing)
    report.say(fmt::format("  tearing: {} above {}", word_of(body.tearing->criterion), body.tearing->threshold));
  else
    report.left_out.emplace_back("does not tear by itself");
  report.left_out.emplace_back("no archive in the haptic node");
  say_loads(body, Eigen::Vector3d::Zero(), settings, report);
  report.sags = is_loaded(body);
  if (kind.own_mesh && report.sags) report.left_out.emplace_back("no sag is told of two meshes that are joined");
  report.memory = memory(body, kind, settings, archive);
  add_near_field("deform_node", settings, archive.surface, true, report);
  warn_of_averaged_strain(body, settings, mean_edge(archive.surface), report);
  if (settings.contact.rule == ContactRule::alpha)
    report.warnings.push_back(
        fmt::format("body '{}' moves: it is touched as under rule \"barycentric\"; \"alpha\" holds nodes of the others",
                    body.name));
}

void warn_of_locking(const std::vector<std::string>& sentences, CheckReport& report) {
  report.warnings.insert(report.warnings.end(), sentences.begin(), sentences.end());
}

std::vector<std::string> locking_warnings(const MovingSpec& body) {
  if (body.dynamic.element == TetElement::nodal_strain) return {};
  return locking_warnings(body,
                          fmt::format("give it element = \"nodal_strain\" in [body.dynamic], or take {}, which true "
                                      "incompressibility stiffens by 4 % only",
                                      kLockingPoisson));
}

}  // namespace palpate
