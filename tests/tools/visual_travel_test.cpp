// A visual surface in a scene's check, and in a log that is drawn where its files are not.
#include <gtest/gtest.h>

#include "common/mesh/obj_file.hpp"
#include "render_node/image.hpp"
#include "tests/mesh/visual_surfaces.hpp"
#include "tests/tools/program_result.hpp"
#include "tools/film/log_pictures.hpp"
#include "tools/logs/log_files.hpp"

namespace palpate {
namespace {

using testing::OwnFolder;
using testing::program;
using testing::run_program;

/// A block with a visual surface about it.
class VisualTravel : public ::testing::Test {
 protected:
  VisualTravel() {
    const VisualMesh mesh = ellipsoid_around({0.055, 0.055, 0.055}, 20, 32);
    write_obj(mesh, scene_.folder() / "look.obj", 1e-3, 3);
    write_mtl(mesh, scene_.folder() / "look.mtl", "look.png");
    Image image{8, 8, std::vector<std::uint8_t>(256, 128)};
    write_png(image, scene_.folder() / "look.png");
  }
  testing::ProgramResult check() const { return run_program(program("palpate") + " check " + scene_.scene()); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(scene_.folder() / name, std::ios::binary) << text;
  }

  static constexpr const char* kVisual =
      "[body.visual]\nsurface = \"look.obj\"\nmaterials = \"look.mtl\"\ntexture = \"look.png\"\nscale = 0.001\n";
  testing::LoopbackScene scene_{"visual", kVisual};
  OwnFolder away_{"visual-away"};
};

TEST_F(VisualTravel, ALogIsDrawnWithTheSurfaceItsColoursAndItsImageWhereTheirFilesAreGone) {
  const auto log = away_ / "a.lcmlog";
  const auto run =
      run_program(fmt::format("{} drive {} --seconds 0.3 --log {}", program("palpate"), scene_.scene(), log.string()));
  ASSERT_EQ(run.status, 0) << run.err;
  std::filesystem::remove_all(scene_.folder());
  const LoggedScene logged(log, {});
  logged.ensure_archives();
  LogPictures pictures(log, contents_of(log, logged.scene()), logged.scene());
  const Frame frame = pictures.at(0.2);
  std::size_t triangles = 0, textured = 0;
  for (const MeshView& mesh : frame.meshes) {
    triangles += mesh.triangles.size();
    textured += mesh.texture.width == 8;
  }
  EXPECT_EQ(triangles, 2u * (2 * 20 - 1) * 32);
  EXPECT_EQ(textured, 1u);
}

TEST_F(VisualTravel, ACheckSaysWhatItIsAndHowFarItStandsOff) {
  const auto said = check();
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.out.find("  visual: 2496 triangles, "), std::string::npos) << said.out;
  EXPECT_NE(said.out.find(" vertices lie outside of the mesh, the farthest 55.0 mm\n"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("  texture: 8 x 8 pixels\n"), std::string::npos) << said.out;
  EXPECT_EQ(said.out.find("is its 'scale' right?"), std::string::npos) << said.out;
}

TEST_F(VisualTravel, ACheckRefusesWhatIsDamagedAndWarnsOfAWrongUnit) {
  const std::string scene = testing::text_of(scene_.scene());
  std::string metres = scene;
  metres.replace(metres.find("scale = 0.001"), 13, "scale = 1");
  write("scene.toml", metres);
  EXPECT_NE(check().out.find("is its 'scale' right?"), std::string::npos);

  write("scene.toml", scene);
  const std::string image = testing::text_of(scene_.folder() / "look.png");
  write("look.png", image.substr(0, image.size() - 20));
  EXPECT_NE(check().err.find("look.png: "), std::string::npos);
  std::string huge = image;
  huge.replace(16, 4, std::string("\x00\x00\x20\x00", 4));
  write("look.png", huge);
  EXPECT_NE(check().err.find("look.png: the image has 8192 x 8 pixels, and may have 4096 a side"), std::string::npos);
  write("look.png", image);
  write("look.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
  EXPECT_NE(check().err.find("look.obj:4: a face asks for number 4 of 3 vertices above it"), std::string::npos);
}

}  // namespace
}  // namespace palpate
