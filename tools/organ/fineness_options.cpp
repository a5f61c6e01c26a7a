#include "tools/organ/fineness_options.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <span>
#include <stdexcept>

#include "common/cli/progress.hpp"
#include "common/files/atomic_file.hpp"
#include "common/mesh/measures.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/surface.hpp"
#include "common/models/quasi_static/free_surface.hpp"
#include "common/models/quasi_static/spec.hpp"
#include "common/models/quasi_static/tensor_work.hpp"
#include "common/scene/scene.hpp"
#include "tools/organ/finding.hpp"
#include "tools/organ/places.hpp"
#include "tools/organ/scene_places.hpp"

namespace palpate {
namespace {

constexpr double kMaxOrgan = 1, kMinOrgan = 5e-3;  // [m]

void write_whole(const TetMesh& mesh, const std::filesystem::path& file) {
  AtomicFile whole(file, 0, AtomicFile::Temporary::named);
  write_tet_mesh(mesh, whole.path());
  whole.commit();
}

double mean_edge_of(const TetMesh& mesh, const Surface& surface) {
  double sum = 0;
  for (const auto& t : surface.triangles)
    for (int c = 0; c < 3; ++c) sum += (mesh.nodes[t[c]] - mesh.nodes[t[(c + 1) % 3]]).norm();
  return sum / (3 * static_cast<double>(surface.triangles.size()));
}

std::size_t bytes_of(std::string_view owner, std::span<const MemoryPart> parts) {
  std::size_t sum = 0;
  for (const MemoryPart& part : parts) sum += part.owner == owner ? part.bytes : 0;
  return sum;
}

/// Of a quasi-static body that can be touched where it is not held, as `palpate check` has it.
void tell_cost(const TetMesh& mesh, Output& out) {
  const SurfaceMap surface = free_surface(mesh);
  const std::vector<MemoryPart> parts = free_surface_memory(surface);
  const std::size_t archive = bytes_of("disk", parts), haptic = bytes_of("haptic_node", parts);
  const WorkTime time = time_of(tensor_work(mesh, surface, offline_of(QuasiStaticSpec{}, surface.size())));
  out.say(fmt::format(
      "  to come, as a quasi_static body, touchable where it is not held: archive of {:.3g} MB{}, "
      "haptic node {:.3g} MB, precomputation {}",
      1e-6 * static_cast<double>(archive), form_of(surface.touchable) == TensorForm::compressed ? " (compressed)" : "",
      1e-6 * static_cast<double>(haptic), time.words));
  out.mesh().update({{"archive_bytes", archive}, {"haptic_node_bytes", haptic}, {"precomputation_s", time.seconds}});
}

void tell_groups(const TetMesh& mesh, Output& out) {
  Output::Json& groups = out.mesh()["groups"] = Output::Json::object();
  for (const auto& [name, group] : mesh.groups) {
    out.say(fmt::format("  group '{}': {} nodes{}", name, group.nodes.size(),
                        group.tetrahedra.empty() ? "" : fmt::format(", {} tetrahedra", group.tetrahedra.size())));
    groups[name] = {{"nodes", group.nodes.size()}, {"tetrahedra", group.tetrahedra.size()}};
  }
}

void tell_mesh(const TetMesh& mesh, const MeshOptions& o, Output& out) {
  const Surface surface = extract_surface(mesh);
  const MeshMeasures m = measures_of(mesh);
  const double edge = mean_edge_of(mesh, surface), mass = o.density * m.volume;
  out.say(fmt::format("{}: {} nodes, {} tetrahedra; surface of {} nodes, {} triangles, mean edge {:.3g} mm", o.output,
                      mesh.nodes.size(), mesh.tetrahedra.size(), surface.nodes.size(), surface.triangles.size(),
                      1e3 * edge));
  out.say(fmt::format("  {} at {} kg/m3", say_size(m, mass), o.density));
  out.say("  " + say_angles(m));
  out.mesh().update({{"file", o.output},
                     {"nodes", mesh.nodes.size()},
                     {"tetrahedra", mesh.tetrahedra.size()},
                     {"surface_nodes", surface.nodes.size()},
                     {"surface_triangles", surface.triangles.size()},
                     {"mean_edge_m", edge},
                     {"extent_m", m.extent},
                     {"volume_m3", m.volume},
                     {"mass_kg", mass},
                     {"smallest_angle_deg", m.min_angle},
                     {"median_angle_deg", m.median_angle},
                     {"largest_angle_deg", m.max_angle}});
  tell_groups(mesh, out);
  if (m.extent.maxCoeff() > kMaxOrgan || m.extent.maxCoeff() < kMinOrgan)
    out.warn(fmt::format("{:.3g} m across: {}", m.extent.maxCoeff(), o.if_strange));
  tell_cost(mesh, out);
}

}  // namespace

void add_mesh_options(cli::Command& command, MeshOptions& o) {
  command.add_option("-o,--output", o.output, "Mesh to write (.msh), in metres").required().output_file(".msh");
  command.add_option("--report", o.report, "Write all that is found and each place of it (.csv)").output_file(".csv");
  command.add_option("--nodes", o.nodes, "About how many nodes, within a tenth; more where --deviation asks for them")
      .between(50, 200000)
      .show_default();
  command.add_option("--edge", o.edge, "Edge length along the surface [m], in place of --nodes")
      .positive()
      .excludes({"--nodes"});
  command.add_option("--inside", o.inside, "Edge length deep inside [m] (default: 2.5 times that on the surface)")
      .positive();
  command.add_option("--deviation", o.deviation, "By how much triangles may miss the surface [m]").positive();
  command.add_option("--fine", o.fine, "Finer there: x,y,z,RADIUS:EDGE or x,y,z,x,y,z:EDGE [m]; may be given again")
      .one_value_each_time();
  command
      .add_option("--tool-radius", o.tool_radius,
                  "Of the tool's tip [m]: edges of half of it on the side that lies farthest from the first --group")
      .positive();
  command
      .add_option("--for", o.scene,
                  "Scene whose tools press the organ: edges of half a tip's radius along their motions (.toml)")
      .excludes({"--tool-radius"});
  command
      .add_option(
          "--group", o.groups,
          "Names nodes of the surface: NAME=below:z (the lowest tenth; above, x, y too), NAME=below:z:0.01, "
          "NAME=box:x,y,z,x,y,z or NAME=plane:x,y,z,nx,ny,nz (what lies behind, against the normal) [m]; may be "
          "given again")
      .one_value_each_time();
  command.add_option("--density", o.density, "For the mass that is printed [kg/m3]").positive().show_default();
  command.add_flag("--json", o.json, "Print one line of JSON");
}

MeshFineness fineness_of(const MeshOptions& o) {
  MeshFineness f{o.nodes, o.edge, o.inside, o.deviation, {}};
  for (const std::string& text : o.fine) f.fine.push_back(parse_fine_place(text));
  check_groups(o.groups);
  if (o.tool_radius > 0 && o.groups.empty())
    throw std::runtime_error("--tool-radius needs a --group: the tool comes to the side that lies farthest from it");
  if (!o.scene.empty()) load_scene(o.scene);  // what cannot be read is told before the organ is
  return f;
}

void add_touched_places(MeshFineness& fineness, const MeshOptions& o, const std::vector<Eigen::Vector3d>& surface,
                        Output& out) {
  std::vector<FinePlace> places;
  if (o.tool_radius > 0) places.push_back(pressed_place(farthest_from_group(o.groups[0], surface), o.tool_radius));
  if (!o.scene.empty()) {
    places = pressed_places(o.scene, surface);
    if (places.empty())
      out.warn(fmt::format("no tool of {} comes here on a way that is written down: nothing is finer for it", o.scene));
  }
  if (!places.empty())
    out.say(fmt::format(
        "  edges of {:.3g} mm where the tool touches, around {}{}", 1e3 * places[0].edge, place_in_mm(places[0].low),
        places.size() == 1 ? "" : fmt::format(", and at {} more places of the way", places.size() - 1)));
  fineness.fine.insert(fineness.fine.end(), places.begin(), places.end());
}

void add_groups(TetMesh& mesh, const MeshOptions& o) {
  for (const std::string& text : o.groups) add_group(mesh, text);
}

void write_mesh(const TetMesh& mesh, const MeshOptions& o, Output& out) {
  write_whole(mesh, o.output);
  tell_mesh(mesh, o, out);
}

void finish_mesh(TetMesh mesh, const MeshOptions& o, Output& out) {
  add_groups(mesh, o);
  write_mesh(mesh, o, out);
}

void say_progress(const std::string& line) {
  cli::say(line);
}

}  // namespace palpate
