#include "tools/check_dynamic.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>

#include "common/contact/cut_surface.hpp"
#include "common/contact/tool_contacts.hpp"
#include "common/dynamics/hybrid_part.hpp"
#include "common/dynamics/make_model.hpp"
#include "common/mesh/cut_mesh.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/hybrid/precompute.hpp"
#include "common/models/moving/precompute.hpp"
#include "common/scene/find_archive.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {
namespace {

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

std::unique_ptr<DynamicModel> make_model(const Body& body, const ElasticMesh& mesh) {
  const Dynamic& motion = as<MovingSpec>(body)->dynamic;
  return as<SpringMassSpec>(body) ? make_spring_model(mesh, motion) : make_element_model(mesh, motion);
}

/// The moving tissue as the deformation node runs it, with the quasi-static part of a hybrid body.
struct Tissue {
  std::unique_ptr<DynamicModel> model;
  std::unique_ptr<HybridPart> rest;
};

Tissue make_tissue(const Body& body, const Archive& archive, double friction) {
  Tissue tissue{make_model(body, elastic_mesh(archive)), nullptr};
  if (!archive.hybrid) return tissue;
  tissue.rest = std::make_unique<HybridPart>(archive, friction, as<MovingSpec>(body)->dynamic.precision == "single");
  tissue.rest->couple(*tissue.model);
  return tissue;
}

void print_step(const Body& body, const Archive& archive) {
  const Tissue tissue = make_tissue(body, archive, 0);
  const double bound = tissue.model->frequency_bound();
  const Dynamic& motion = as<MovingSpec>(body)->dynamic;
  const double largest = max_step(integrator_of(motion), bound, motion.damping);
  if (motion.step > largest)
    throw std::runtime_error(fmt::format("body '{}': a step of {:.4g} s is not stable; the bound is {:.4g} s",
                                         name_of(body), motion.step, largest));
  const std::string taken = motion.step > 0 ? fmt::format("{} s is taken", motion.step) : "one below is taken";
  fmt::print("  step: stable up to {:.4g} s, for frequencies up to {:.4g} rad/s; {}\n", largest, bound, taken);
}

/// Bytes that the process has from its heap.
std::size_t heap_in_use() {
  const auto heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

double pedal_time(const Trajectory& trajectory) {
  constexpr double kStep = 1e-3;
  double sum = 0;
  for (int i = 0; kStep * i < trajectory.duration(); ++i) sum += kStep * trajectory.at(kStep * i).pedal;
  return sum;
}

bool ever_closes(const Trajectory& trajectory, double closed_below) {
  constexpr double kStep = 1e-3;
  bool open = false;
  for (int i = 0; kStep * i <= trajectory.duration(); ++i) {
    const bool closed = trajectory.at(kStep * i).grip < closed_below;
    if (open && closed) return true;
    open = open || !closed;
  }
  return false;
}

}  // namespace

Archive dynamic_archive(const Scene& scene, const Body& body, const TetMesh& mesh) {
  if (std::filesystem::exists(archive_path(body))) {
    try {
      return find_archive(scene, body, ArchivePart::surface);
    } catch (const std::exception&) {
      // Refused, which the caller says: computed below.
    }
  }
  const auto* hybrid = as<HybridSpec>(body);
  if (!hybrid) return precompute_moving(*as<MovingSpec>(body), kind_of(body), mesh);
  if (hybrid->hybrid.mesh.empty()) return precompute(*hybrid, mesh);
  const TetMesh coarse = load_tet_mesh(hybrid->hybrid.mesh, hybrid->hybrid.scale);
  return precompute(*hybrid, mesh, &coarse);
}

void print_dynamic(const Body& body, const TetMesh& mesh, const Archive& archive) {
  const std::size_t moving = archive.tetrahedra.size();
  fmt::print("  moving: {} nodes, {} tetrahedra, {} edges", moving_nodes(archive), moving, edge_count(archive));
  if (archive.hybrid) {
    const bool own_mesh = !as<HybridSpec>(body)->hybrid.mesh.empty();
    const double whole = static_cast<double>(mesh.tetrahedra.size() + (own_mesh ? moving : 0));
    fmt::print(", {:.1f} % of the tetrahedra; joined to the quasi-static part at {} nodes",
               100 * static_cast<double>(moving) / whole, archive.hybrid->connection.size());
    if (own_mesh) fmt::print(", gap at rest {:.3g} m", archive.hybrid->max_gap);
  }
  const MovingSpec& spec = *as<MovingSpec>(body);
  const Dynamic& d = spec.dynamic;
  fmt::print("\n  motion: {}, {} precision, damping {} 1/s, gravity {} {} {} m/s2{}\n", d.integrator, d.precision,
             d.damping, d.gravity.x(), d.gravity.y(), d.gravity.z(), d.corotational ? ", corotational" : "");
  print_step(body, archive);
  if (spec.tearing) fmt::print("  tearing: {} above {}\n", spec.tearing->criterion, spec.tearing->threshold);
}

std::vector<MemoryPart> dynamic_memory(const Scene& scene, const Body& body, const Archive& archive) {
  std::vector<MemoryPart> parts;
  const auto add = [&](const char* owner, const char* what, std::size_t bytes) {
    parts.push_back({owner, what, bytes});
  };
  const std::size_t nodes = archive.surface.size(), triangles = archive.surface.triangles.size();
  const std::size_t tetrahedra = archive.tetrahedra.size();
  add("disk", "archive: tetrahedra, surface and numbering",
      nodes * (3 * sizeof(double) + 4 * sizeof(int)) + 3 * triangles * sizeof(int) + 4 * tetrahedra * sizeof(int));
  if (archive.hybrid) {
    const HybridTensors& h = *archive.hybrid;
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
  const auto model = make_model(body, mesh);
  add("deform_node", "masses, tensors and motion", measured());
  std::unique_ptr<HybridPart> rest;
  if (archive.hybrid) {
    rest = std::make_unique<HybridPart>(archive, scene.contact.friction,
                                        as<MovingSpec>(body)->dynamic.precision == "single");
    add("deform_node", "quasi-static part", measured());
  }
  const CutMesh topology(mesh.tetrahedra, mesh.nodes());
  const std::size_t of_topology = measured();
  add("deform_node", "topology that is cut", of_topology);
  const double size = scene.contact.bucket_size > 0 ? scene.contact.bucket_size : 2 * mean_edge(archive.surface);
  const CutSurface surface(topology, mesh.rest, size);
  add("deform_node", "surface and buckets", measured());
  add("render_node", "topology that is cut", of_topology);
  add("render_node", "visible surface", nodes * 2 * sizeof(Eigen::Vector3f) + 3 * triangles * sizeof(int));
  return parts;
}

std::vector<std::string> cutting_warnings(const Scene& scene) {
  std::vector<std::string> warnings;
  const bool cuttable = std::ranges::any_of(scene.bodies, [](const Body& b) { return as<MovingSpec>(b) != nullptr; });
  for (const Tool& tool : scene.tools) {
    const ProbeSpec* probe = tool.probe();
    if (!probe) continue;
    if (probe->cautery && !cuttable)
      warnings.push_back(fmt::format("tool '{}' has a cautery, and no body is dynamic: it cuts nothing", tool.name));
    const auto* script = std::get_if<ScriptedDeviceSpec>(&tool.device);
    if (!script) continue;
    const Trajectory trajectory = load_trajectory(script->trajectory);
    if (probe->cautery && pedal_time(trajectory) == 0)
      warnings.push_back(
          fmt::format("tool '{}' has a cautery, and the pedal of its trajectory is never down", tool.name));
    if (probe->jaws && !ever_closes(trajectory, probe->jaws->closed_below))
      warnings.push_back(fmt::format("tool '{}' has jaws, and the grip of its trajectory never falls below {} rad",
                                     tool.name, probe->jaws->closed_below));
  }
  return warnings;
}

}  // namespace palpate
