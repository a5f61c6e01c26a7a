#include <gtest/gtest.h>

#include "common/mesh/generators.hpp"
#include "common/mesh/surface.hpp"
#include "render_node/stage.hpp"
#include "tests/render/scenery.hpp"

namespace palpate {
namespace {

using namespace testing;

/// A block of which the tetrahedra on the right (x > 0) move.
struct HalfMovingBlock {
  TetMesh mesh = make_block({-0.06, -0.04, -0.04}, {0.06, 0.04, 0.04}, {6, 2, 2});
  std::vector<std::array<int, 4>> moving;
  Scene scene;
  SurfaceMap map;

  HalfMovingBlock() {
    for (const auto& t : mesh.tetrahedra)
      if (middle(t).x() > 0) moving.push_back(t);
    scene.bodies.emplace_back(TensorMassSpec{});
    scene.render.emplace();
    scene.render->camera = empty_frame().camera;
    scene.render->colour = Colouring::parts;
    map.position = mesh.nodes;
    map.triangles = extract_surface(mesh).triangles;
  }
  template <std::size_t N>
  Eigen::Vector3d middle(const std::array<int, N>& nodes) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int n : nodes) sum += mesh.nodes[n];
    return sum / N;
  }
  Stage stage() const {
    Stage stage(scene, std::span(&map, 1), {});
    stage.colour_parts(0, moving);
    return stage;
  }
};

TEST(PartsStage, EachTriangleIsInThePartWhoseTetrahedronItBounds) {
  const HalfMovingBlock block;
  const Stage stage = block.stage();
  const Frame frame = stage.frame();
  ASSERT_EQ(frame.meshes.size(), 2u);
  EXPECT_EQ(frame.meshes[0].triangles.size() + frame.meshes[1].triangles.size(), block.map.triangles.size())
      << "the mesh itself, not refined";
  for (const auto& t : frame.meshes[0].triangles) EXPECT_LT(block.middle(t).x(), 0);
  for (const auto& t : frame.meshes[1].triangles) EXPECT_GT(block.middle(t).x(), 0);
}

TEST(PartsStage, ItsWiresAreItsEdgesOnce) {
  const HalfMovingBlock block;
  const Stage stage = block.stage();
  for (const MeshView& part : stage.frame().meshes) {
    // An open surface has 3 F = 2 E - B edges: those of its border, where the parts meet, belong to one triangle.
    const std::size_t border = 8;
    EXPECT_EQ(3 * part.triangles.size(), 2 * part.edges.size() - border);
  }
}

TEST(PartsStage, ThePictureShowsBlueAndOrangeUnderDarkWires) {
  const HalfMovingBlock block;
  const Stage stage = block.stage();
  const Image seen = picture(stage.frame());
  std::array<int, 2> blue{}, orange{};  // pixels on the left, on the right
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) {
      const std::uint8_t* p = seen.pixel(x, y);
      blue[x >= 160] += p[2] > 1.5 * p[0];
      orange[x >= 160] += p[0] > 1.5 * p[2] && brightness(seen, x, y) > 60;
    }
  EXPECT_GT(blue[0], 2000);
  EXPECT_LT(blue[1], 100);
  EXPECT_GT(orange[1], 2000);
  EXPECT_LT(orange[0], 100);
  Frame bare = stage.frame();
  for (MeshView& mesh : bare.meshes) mesh.edges = {};
  const Image without = picture(bare);
  int darker = 0;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) darker += brightness(seen, x, y) < 0.5 * brightness(without, x, y);
  EXPECT_GT(darker, 500) << "a wire a pixel wide";
  EXPECT_LT(darker, 6000);
}

TEST(PartsStage, ACutBaresFacesOfThePartThatMoves) {
  const HalfMovingBlock block;
  Stage stage = block.stage();
  const std::size_t before = stage.frame().meshes[0].triangles.size();
  std::vector<std::array<int, 3>> cut = block.map.triangles;
  std::erase_if(cut, [&](const auto& t) { return block.middle(t).x() > 0.05; });
  const auto& [a, b, c, d] = block.moving.front();
  cut.push_back({a, b, c});
  stage.set_triangles(0, cut);
  const Frame frame = stage.frame();
  EXPECT_EQ(frame.meshes[0].triangles.size(), before);
  EXPECT_EQ(frame.meshes[1].triangles.size(), cut.size() - before);
}

}  // namespace
}  // namespace palpate
