// Meshes, motions and scenes with numbers that cannot be, pieces that are gone or come twice, and bytes of no meaning:
// they are read, or refused in a sentence that names the file.
#include <gtest/gtest.h>

#include "common/files/png_file.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/obj_file.hpp"
#include "common/mesh/quality.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/scene/scene.hpp"
#include "common/tool/trajectory.hpp"
#include "render_node/image.hpp"
#include "tests/fuzz/spoil.hpp"
#include "tests/mesh/literal_files.hpp"
#include "tests/mesh/visual_surfaces.hpp"
#include "tests/scene/full_scene.hpp"
#include "tests/tensors/files_for_tests.hpp"

namespace palpate {
namespace {

using testing::reads;
using testing::Sample;
using testing::spoil_all;

TEST(MeshFuzz, AMeshIsReadOrRefusedInWords) {
  setenv("PALPATE_CACHE", "/dev/null", 1);  // readings of spoiled files are not kept
  const std::vector<Sample> samples{{"a.msh", kGmsh1},
                                    {"b.msh", kGmsh2},
                                    {"c.msh", gmsh2_binary()},
                                    {"d.msh", kGmsh4},
                                    {"e.msh", gmsh4_binary()},
                                    {"f.vtk", kVtk},
                                    {"g.vtk", vtk_binary<double>("double")},
                                    {"h.stl", kStl}};
  spoil_all(samples, 160, 1, [](const std::filesystem::path& file) {
    const bool solid = reads(file, [&] { check_tet_mesh(load_tet_mesh(file, 1), file.string()); });
    const bool shell = reads(file, [&] { load_shell_mesh(file, 1); });
    return reads(file, [&] { load_triangle_mesh(file, 1); }) || solid || shell;
  });
}

/// A visual surface, its materials and its image.
TEST(VisualFuzz, AVisualSurfaceIsReadOrRefusedInWords) {
  const testing::TemporaryFolder folder;
  const VisualMesh mesh = ellipsoid_around({0.05, 0.04, 0.03}, 3, 5);
  write_obj(mesh, folder / "a.obj", 1e-3, 3);
  write_mtl(mesh, folder / "a.mtl", "a.png");
  Image image{16, 8, std::vector<std::uint8_t>(std::size_t{4} * 16 * 8, 99)};
  write_png(image, folder / "a.png");
  const ObjMaterials materials = load_mtl(folder / "a.mtl");
  std::vector<Sample> samples;
  for (const char* name : {"a.obj", "a.mtl", "a.png"}) {
    const auto bytes = testing::read_bytes(folder / name);
    samples.push_back({name, {bytes.begin(), bytes.end()}});
  }
  spoil_all(samples, 3000, 4, [&](const std::filesystem::path& file) {
    return reads(file, [&] {
      if (file.extension() == ".obj") {
        const VisualMesh read = load_obj(file, 1e-3, materials, true);
        for (const VisualMesh::Part& part : read.parts)
          for (const auto& triangle : part.triangles)
            for (const int vertex : triangle) ASSERT_TRUE(vertex >= 0 && vertex < part.count);
      } else if (file.extension() == ".mtl") {
        load_mtl(file);
      } else {
        decode_png(read_png_bytes(file, kMaxTextureSide), file);
      }
    });
  });
}

TEST(MotionFuzz, AMotionIsReadOrRefusedInWords) {
  const Sample motion{
      "motion.csv",
      "time,yaw,pitch,depth,roll,grip,pedal\n0,0,0,0.17,0,0,0\n0.5,0,0,0.18,0,0,1\n1.0,0,0.1,0.2,0,0,0\n"};
  spoil_all({motion}, 2000, 2, [](const std::filesystem::path& file) {
    return reads(file, [&] {
      const Trajectory trajectory = load_trajectory(file);
      for (const double t : {0.0, 0.3, 0.75, 1e9}) {
        const ToolDofs dofs = trajectory.at(t);
        EXPECT_TRUE(std::isfinite(dofs.yaw + dofs.pitch + dofs.depth + dofs.roll + dofs.grip));
      }
    });
  });
}

TEST(SceneFileFuzz, ASceneIsReadOrRefusedInWords) {
  const SceneFolder folder;  // what they name is there
  const auto place = folder / "scene.toml";
  spoil_all({{"a.toml", kFullScene}, {"b.toml", kMinimalScene}}, 2000, 3, [&](const std::filesystem::path& file) {
    const auto bytes = testing::read_bytes(file);
    return reads(place, [&] { parse_scene({bytes.begin(), bytes.end()}, place); });
  });
}

}  // namespace
}  // namespace palpate
