#include <gtest/gtest.h>

#include <fstream>

#include "common/mesh/generators.hpp"
#include "common/mesh/shown_surface.hpp"
#include "common/mesh/surface.hpp"
#include "render_node/stage.hpp"
#include "tests/mesh/visual_surfaces.hpp"
#include "tests/render/scenery.hpp"

namespace palpate {
namespace {

using namespace testing;
using Eigen::Vector3f;

/// A block under a visual ellipsoid, whose upper half wears an image of one green, and whose lower half is blue.
struct VisualBlock {
  TetMesh mesh = make_block({-0.05, -0.04, -0.03}, {0.05, 0.04, 0.03}, {5, 4, 3});
  Scene scene;
  SurfaceMap map;
  Folder folder;

  VisualBlock() {
    scene.bodies.emplace_back(TensorMassSpec{});
    as<SolidSpec>(scene.bodies[0])->visual.emplace();
    scene.render.emplace();
    scene.render->camera = empty_frame().camera;
    map.position = mesh.nodes;
    map.triangles = extract_surface(mesh).triangles;
  }

  std::string image(const std::array<std::uint8_t, 3>& colour) const {
    Image image{4, 4, {}};
    for (int pixel = 0; pixel < 16; ++pixel)
      image.rgba.insert(image.rgba.end(), {colour[0], colour[1], colour[2], 255});
    write_png(image, folder.path / "image.png");
    std::ifstream in(folder.path / "image.png", std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  Stage stage(const std::string& texture) const {
    VisualBody visual{ellipsoid_around({0.06, 0.05, 0.04}), {}, texture};
    visual.mesh.parts[1].colour = {0.05, 0.1, 0.7};
    visual.binding = bind_visual(visual.mesh.position, map.position, map.triangles, mesh.tetrahedra);
    std::vector<std::optional<VisualBody>> visuals;
    visuals.emplace_back(std::move(visual));
    return Stage(scene, std::span(&map, 1), {}, std::move(visuals));
  }
};

std::size_t triangles_of(const Frame& frame, Finish finish) {
  std::size_t sum = 0;
  for (const MeshView& mesh : frame.meshes)
    if (mesh.finish == finish) sum += mesh.triangles.size();
  return sum;
}

TEST(VisualStage, IsDrawnInPlaceOfTheBodyInItsColoursAndItsImage) {
  const VisualBlock block;
  const Stage stage = block.stage(block.image({30, 200, 40}));
  const Frame frame = stage.frame();
  ASSERT_EQ(frame.meshes.size(), 2u);
  EXPECT_EQ(frame.meshes[0].texture.width, 4);
  EXPECT_TRUE(frame.meshes[1].image.empty());
  const Image seen = picture(frame);
  const std::uint8_t *upper = seen.pixel(160, 100), *lower = seen.pixel(160, 140);
  EXPECT_GT(upper[1], 2 * upper[0]) << "green";
  EXPECT_GT(upper[1], 2 * upper[2]);
  EXPECT_GT(lower[2], 1.5 * lower[0]) << "blue";
  EXPECT_GT(lower[2], 1.2 * lower[1]);
}

TEST(VisualStage, ASecondImageOfTheSameNumberIsDrawnToo) {
  const VisualBlock block;
  Renderer renderer(320, 240);
  Image seen;
  const Stage green = block.stage(block.image({30, 200, 40})), red = block.stage(block.image({200, 30, 40}));
  renderer.draw(green.frame(), seen);
  renderer.draw(red.frame(), seen);
  EXPECT_GT(seen.pixel(160, 100)[0], 2 * seen.pixel(160, 100)[1]);
}

TEST(VisualStage, FollowsTheBody) {
  const VisualBlock block;
  Stage stage = block.stage(block.image({30, 200, 40}));
  std::vector<Vector3f> position, normal(block.map.position.size(), Vector3f::UnitZ());
  for (const auto& p : block.map.position) position.push_back(p.cast<float>() + Vector3f(0, 0, 0.2f));
  stage.set_surface(0, position, normal);
  for (const MeshView& mesh : stage.frame().meshes)
    for (std::size_t v = 0; v < mesh.position.size(); ++v)
      EXPECT_LT((mesh.position[v] - mesh.rest[v] - Vector3f(0, 0, 0.2f)).norm(), 1e-6f);
}

TEST(VisualStage, ACutTakesItsPartsAlongAndShowsTheMeshWhereItOpens) {
  const VisualBlock block;
  Stage stage = block.stage(block.image({30, 200, 40}));
  const std::size_t whole = triangles_of(stage.frame(), Finish::tissue);
  CutMesh opened(block.mesh.tetrahedra, static_cast<int>(block.mesh.nodes.size()));
  ShownSurface shown(block.map.triangles, opened);
  std::vector<int> removed, piece;
  for (int t = 0; t < opened.size(); ++t) {
    double middle = 0, up = 0;
    for (const int n : opened.tetrahedron(t)) {
      middle += block.mesh.nodes[n].x() / 4;
      up += block.mesh.nodes[n].z() / 4;
    }
    if (std::abs(middle) < 0.01 && up > 0) opened.remove(t, removed);
  }
  opened.parts(piece);
  for (int& part : piece)
    if (part >= 0) ++part;
  stage.part_visual(0, piece);
  stage.set_triangles(0, shown.triangles(opened));
  const Frame frame = stage.frame();
  ASSERT_EQ(frame.meshes.size(), 3u) << "what is bared of the mesh, and two parts of the visual surface";
  EXPECT_TRUE(frame.meshes[0].image.empty());
  EXPECT_GT(frame.meshes[0].triangles.size(), 0u);
  EXPECT_LT(frame.meshes[1].triangles.size(), whole);
  EXPECT_GT(frame.meshes[1].triangles.size(), whole / 2);
}

TEST(VisualStage, ADamagedImageIsRefusedInWordsWithItsName) {
  const VisualBlock block;
  const std::string whole = block.image({30, 200, 40});
  for (const std::size_t kept : {std::size_t{8}, std::size_t{30}, whole.size() - 14}) {
    const std::string said = complaint([&] { decode_png(whole.substr(0, kept), "a.png"); });
    EXPECT_TRUE(said.starts_with("a.png: ")) << kept << ": " << said;
  }
}

}  // namespace
}  // namespace palpate
