#include <fmt/format.h>

#include <map>
#include <memory>
#include <stdexcept>

#include "tools/organ/commands.hpp"
#include "tools/organ/fineness_options.hpp"
#include "tools/organ/idle_places.hpp"
#include "tools/organ/surface_extent.hpp"
#include "tools/organ/surface_file.hpp"
#include "tools/organ/surface_repair.hpp"
#include "tools/organ/surface_shells.hpp"
#include "tools/organ/surface_solid.hpp"

namespace palpate {
namespace {

const std::map<std::string, double> kUnits{{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"in", 0.0254}};

struct SurfaceOptions : MeshOptions {
  std::string surface, unit = "m";
  double hole = 0;
};

RepairedSurface repaired(const ReadSurface& read, const SurfaceOptions& o, Output& out) {
  std::vector<Finding> findings = read.findings;
  RepairedSurface surface;
  tell_refused_too([&] { tell_findings(findings, o.report, out); },
                   [&] { surface = of_file(o.surface, [&] { return repair_surface(read.mesh, o.hole, findings); }); });
  if (findings.empty()) out.say("  found: nothing to repair");
  return surface;
}

void make_mesh(const SurfaceOptions& o) {
  Output out(o.json);
  MeshFineness fineness = fineness_of(o);
  const ReadSurface read = read_surface(o.surface, kUnits.at(o.unit));
  out.say(fmt::format("{}: {} triangles", o.surface, read.mesh.triangles.size()));
  out.figures().update({{"surface", o.surface}, {"triangles", read.mesh.triangles.size()}});
  say_progress("checking the surface");
  const RepairedSurface surface = repaired(read, o, out);
  add_touched_places(fineness, o, surface.mesh.nodes, out);
  SurfaceSolid solid = of_file(o.surface, [&] {
    check_extent(surface.mesh);  // again: what made it large may be left out
    return solid_of(surface.mesh);
  });
  if (surface.crosses_itself) solid.measures.volumes.clear();
  out.next_mesh();
  const TetMesh mesh = make_organ_mesh(solid.solid, solid.measures, fineness, say_progress).mesh;
  finish_mesh(mesh, o, out);
  warn_of_idle_places(o, {{mesh, out.mesh().at("mean_edge_m")}}, out);
  out.finish();
}

}  // namespace

void add_mesh_command(cli::Command& app) {
  cli::Command command = app.add_command(
      "mesh", "Make a mesh of tetrahedra of a surface (STL, OBJ, PLY, OFF, VTK, VTP), repaired where it has to be");
  auto o = std::make_shared<SurfaceOptions>();
  command.add_option("SURFACE", o->surface, "Surface file").required();
  std::vector<std::string> units;
  for (const auto& [name, metres] : kUnits) units.push_back(name);
  command.add_option("--unit", o->unit, "Unit of the file's coordinates").one_of(units).show_default();
  command
      .add_option("--hole", o->hole,
                  "Close holes of up to this size [m] (default: a fifth of the diagonal of the largest shell)")
      .positive();
  add_mesh_options(command, *o);
  command.tells_progress();
  command.examples({"palpate mesh liver.stl --unit mm --nodes 2000 --group attachment=above:z -o liver.msh"});
  command.does([o] { make_mesh(*o); });
}

}  // namespace palpate
