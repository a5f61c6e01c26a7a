#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "common/mesh/mesh_file.hpp"
#include "tools/scene_for_mesh.hpp"
#include "tools/shared/commands.hpp"
#include "tools/visual_about.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

struct SceneOptions {
  std::string mesh, output, tissue, visual;
  bool force = false;  ///< files of another kind are written over
  SceneWishes wishes;
};

const Tissue& tissue_of(const SceneOptions& o) {
  const std::string name = o.tissue.empty() ? fs::path(o.mesh).stem().string() : o.tissue;
  if (const Tissue* const tissue = find_tissue(name)) return *tissue;
  throw std::runtime_error(
      fmt::format("'{}' is no tissue that is known: give --tissue one of {}", name, tissue_names()));
}

/// As a scene in the folder names them.
VisualSpec seen_from(const fs::path& folder, VisualSpec visual) {
  for (fs::path* const file : {&visual.surface, &visual.materials, &visual.texture})
    if (!file->empty()) *file = fs::proximate(fs::absolute(*file), folder);
  return visual;
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error(file.string() + ": the file cannot be written");
}

void make_scene(const SceneOptions& o) {
  const Tissue& tissue = tissue_of(o);
  const fs::path scene = fs::absolute(o.output), folder = scene.parent_path();
  const fs::path trajectory = folder / (scene.stem().string() + "_motion.csv");
  cli::require_output(trajectory, ".csv", {"motion"}, o.force);
  const std::string mesh_name = fs::proximate(fs::absolute(o.mesh), folder).string();
  const SceneTexts texts = [&] {
    const TetMesh mesh = load_tet_mesh(o.mesh, 1);
    SceneWishes wishes = o.wishes;
    if (!o.visual.empty()) wishes.visual = seen_from(folder, visual_about(mesh, o.visual));
    try {
      return scene_for(mesh, mesh_name, trajectory.filename(), tissue, wishes);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("{}: {}", o.mesh, error.what()));
    }
  }();
  write(trajectory, texts.trajectory);
  write(o.output, texts.scene);
  fmt::print("{}: {}, young {} Pa (published: {} to {} Pa, {})\n", o.output, tissue.name, tissue.young,
             tissue.young_low, tissue.young_high, tissue.source);
  fmt::print("  next: palpate check {0} and palpate run {0}\n", o.output);
}

}  // namespace

void add_scene_command(cli::Command& app) {
  cli::Command command = app.add_command(
      "scene", "Make a scene of a mesh: its material, what holds it, a probe with a first motion, a camera");
  auto o = std::make_shared<SceneOptions>();
  command.add_option("MESH", o->mesh, "Mesh of tetrahedra in metres (.msh, .vtk)").required();
  command.add_option("-o,--output", o->output, "Scene to write (.toml); its motion goes beside it")
      .required()
      .output_file(".toml");
  command.add_option("--tissue", o->tissue,
                     fmt::format("What it is of (default: the mesh's name): {}", tissue_names()));
  command.add_option("--visual", o->visual,
                     "Surface that is drawn in place of the mesh's own, in metres or millimetres (.obj, with its .mtl "
                     "and .png beside it; .stl; a mesh's own of a .msh or .vtk)");
  command.add_option("--fixed", o->wishes.fixed, "Group of the mesh by which it is held").show_default();
  command.add_option("--radius", o->wishes.radius, "Radius of the probe's tip [m]").positive().show_default();
  command
      .add_option("--press", o->wishes.press,
                  "How deep it presses [m] (default: a fortieth of the diagonal, half the radius at most)")
      .positive();
  command.examples({"palpate scene organ.msh --tissue liver -o organ.toml",
                    "palpate scene organ.msh --tissue liver --visual organ_look.obj -o organ.toml"});
  command.does([o, command] {
    o->force = command.given("--force");
    make_scene(*o);
  });
}

}  // namespace palpate
