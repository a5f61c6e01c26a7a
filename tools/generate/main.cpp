#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "common/cli/command_line.hpp"
#include "common/mesh/generators.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/obj_file.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/mesh/shell_quality.hpp"
#include "tools/generate/cylinders.hpp"
#include "tools/generate/duct.hpp"
#include "tools/generate/duct_motions.hpp"
#include "tools/generate/hepatectomy.hpp"
#include "tools/generate/liver.hpp"
#include "tools/generate/liver_visual.hpp"
#include "tools/generate/plate.hpp"
#include "tools/generate/plate_cut.hpp"
#include "tools/generate/ribs.hpp"

namespace {

using namespace palpate;

struct BlockOptions {
  std::array<double, 3> min{-0.05, -0.05, -0.1}, max{0.05, 0.05, 0};
  std::array<int, 3> cells{10, 10, 10};
  double growth = 1;
};

struct CylinderOptions {
  double radius = 0.015, height = 0.013;
  double size = 0.0025;
};

/// Finest at the middle of the top face: steps grow by `growth` outwards and downwards.
TetMesh make_top_centred_block(const BlockOptions& o) {
  if (o.growth == 1) {
    return make_block(Eigen::Vector3d(o.min.data()), Eigen::Vector3d(o.max.data()), o.cells);
  }
  return make_graded_block(centred_axis(o.min[0], o.max[0], o.cells[0], o.growth),
                           centred_axis(o.min[1], o.max[1], o.cells[1], o.growth),
                           graded_axis(o.min[2], o.max[2], o.cells[2], 1 / o.growth));
}

/// Rings and layers for elements of about `size`; the layers are even, so that mid-height carries nodes.
TetMesh make_sized_cylinder(const CylinderOptions& o) {
  const int rings = std::max(1, static_cast<int>(std::lround(o.radius / o.size)));
  const int layers = std::max(2, 2 * static_cast<int>(std::lround(o.height / o.size / 2)));
  return make_cylinder(o.radius, o.height, rings, layers);
}

void save(const TetMesh& mesh, const std::filesystem::path& file) {
  check_tet_mesh(mesh, file.string());
  write_tet_mesh(mesh, file);
  double angle = std::numbers::pi;
  for (const auto& t : mesh.tetrahedra) angle = std::min(angle, min_dihedral_angle(mesh, t));
  std::printf("%s: %zu nodes, %zu tetrahedra, smallest dihedral angle %.1f degrees\n", file.c_str(), mesh.nodes.size(),
              mesh.tetrahedra.size(), angle * 180 / std::numbers::pi);
}

void save(const TriangleMesh& mesh, const std::filesystem::path& file) {
  write_stl(mesh, file);
  std::printf("%s: %zu nodes, %zu triangles\n", file.c_str(), mesh.nodes.size(), mesh.triangles.size());
}

void save(const ShellMesh& mesh, const std::filesystem::path& file) {
  check_shell_mesh(mesh, file.string());
  write_shell_mesh(mesh, file);
  std::printf("%s: %zu nodes, %zu triangles, lumen of the middle surface %.2f mm\n", file.c_str(), mesh.nodes.size(),
              mesh.triangles.size(), 2e3 * lumen_radius(mesh));
}

/// As OBJ in millimetres, with its materials and its image beside it.
void save_liver_visual(const std::filesystem::path& file) {
  const VisualMesh mesh = make_liver_visual();
  const std::filesystem::path image = std::filesystem::path(file).replace_extension(".png");
  write_obj(mesh, file, 1e-3, 2);
  write_mtl(mesh, std::filesystem::path(file).replace_extension(".mtl"), image.filename());
  write_liver_texture(image);
  std::printf("%s: %zu vertices, %zu triangles, %zu materials\n", file.c_str(), mesh.position.size(), mesh.triangles(),
              mesh.parts.size());
}

/// Writes the trajectories that a scene of the duct names; the files must be there already, as for every scene.
void save_motions(const std::filesystem::path& file) {
  const Scene scene = load_scene(file);
  for (const Tool& tool : scene.tools) {
    const auto* script = std::get_if<ScriptedDeviceSpec>(&tool.device);
    if (!script) throw std::runtime_error("the tool '" + tool.name + "' is not scripted and names no trajectory");
    std::ofstream out(script->trajectory, std::ios::binary);
    out << duct_motion(scene, tool);
    if (!out.flush()) throw std::runtime_error(script->trajectory.string() + ": the file cannot be written");
    std::printf("%s\n", script->trajectory.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  palpate::cli::CommandLine app{"Makes the meshes of the example scenes and some of their motions"};
  app.require_command();
  std::filesystem::path file;
  const auto add_shape = [&](const char* name, const char* what, const std::function<void()>& make) {
    cli::Command shape = app.add_command(name, what);
    shape.add_option("-o,--output", file, "File to write")
        .required()
        .output_file("", {".msh", ".csv", ".stl", "motion"});
    shape.does(make);
    return shape;
  };

  LiverOptions liver;
  cli::Command shape = add_shape("liver", "the default organ (.msh)", [&] { save(make_liver(liver), file); });
  shape.add_option("--frequency", liver.frequency, "Fineness f of the surface: 10 f^2 + 2 nodes").between(2, 64);
  shape.add_option("--size", liver.inner_size, "Edge length inside [m]").positive();

  add_shape("liver_visual", "how it looks, with gall bladder and vessels (.obj, .mtl and .png)",
            [&] { save_liver_visual(file); });

  int plate_cells = 18;
  shape = add_shape("plate", "a thin square plate (.msh)", [&] { save(make_plate(plate_cells), file); });
  shape.add_option("--cells", plate_cells, "Cells along each side").between(4, 1000);

  add_shape("ribs", "the backdrop of the liver scene (.stl)", [&] { save(make_ribs(), file); });

  add_shape("hepatectomy", "the organ a segment of which is cut off (.msh)", [&] { save(make_hepatectomy(), file); });
  add_shape("plate_cut", "the plate that is cut (.msh)", [&] { save(make_plate_cut(), file); });
  add_shape("cylinder_tear", "the cylinder that tears (.msh)", [&] { save(make_cylinder_tear(), file); });
  add_shape("cylinder_hybrid", "the cylinder of two halves (.msh)", [&] { save(make_cylinder_hybrid(), file); });

  add_shape("duct", "the cystic duct, a surface (.msh)", [&] { save(make_duct(), file); });
  shape = app.add_command("motions", "the trajectories of a scene of the duct");
  shape.add_option("SCENE", file, "Scene file, which names them").required();
  shape.does([&] { save_motions(file); });

  BlockOptions block;
  shape = add_shape("block", "a block (.msh)", [&] { save(make_top_centred_block(block), file); });
  shape.add_option("--min", block.min, "Lowest corner [m]");
  shape.add_option("--max", block.max, "Highest corner [m]");
  shape.add_option("--cells", block.cells, "Cells along x, y, z");
  shape.add_option("--growth", block.growth, "Growth of the cells away from the middle of the top; 1: uniform");

  CylinderOptions cylinder;
  shape =
      add_shape("cylinder", "a cylinder about the z axis (.msh)", [&] { save(make_sized_cylinder(cylinder), file); });
  shape.add_option("--radius", cylinder.radius, "[m]").positive();
  shape.add_option("--height", cylinder.height, "[m]").positive();
  shape.add_option("--size", cylinder.size, "Edge length aimed at [m]").positive();

  try {
    if (const auto status = app.read(argc, argv)) return *status;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate_generate: %s\n", error.what());
    return 1;
  }
  return 0;
}
