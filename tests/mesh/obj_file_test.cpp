#include "common/mesh/obj_file.hpp"

#include <gtest/gtest.h>

#include "tests/mesh/mesh_test_helpers.hpp"
#include "tests/mesh/visual_surfaces.hpp"

namespace palpate {
namespace {

const std::string kMaterials = R"(# of an organ
newmtl liver
map_Kd liver.png
newmtl gall bladder
Kd 0.1 0.2 0.05
Ns 90
)";

const std::string kObj = R"(mtllib organ.mtl
o organ
v 0 0 0
v 10 0 0
v 10 10 0 1.0
v 0 10 0
v 0 0 5
vt 0 0
vt 1 0.25
vt 1 1
vn 0 0 1
usemtl liver
s 1
f 1/1/1 2/2/1 3/3/1
f -5/-3 -3/-1 -2/-2
usemtl gall bladder
f 1 2 5
f 1//1 2//1 3//1 4//1
l 1 2
)";

VisualSpec spec_in(const TestFolder& folder, const std::string& obj, const std::string& mtl) {
  VisualSpec spec;
  spec.surface = folder.write("organ.obj", obj);
  if (!mtl.empty()) spec.materials = folder.write("organ.mtl", mtl);
  spec.texture = folder.write("liver.png", "never read here");
  spec.scale = 1e-3;
  return spec;
}

TEST(ObjFile, GivesPartsByMaterialWithTheirPlaceInTheImage) {
  const TestFolder folder;
  const VisualMesh mesh = load_visual_mesh(spec_in(folder, kObj, kMaterials));
  ASSERT_EQ(mesh.parts.size(), 2u);
  EXPECT_EQ(mesh.parts[0].material, "liver");
  EXPECT_TRUE(mesh.parts[0].textured);
  EXPECT_EQ(mesh.parts[0].triangles.size(), 2u);
  EXPECT_EQ(mesh.parts[1].material, "gall bladder");
  EXPECT_FALSE(mesh.parts[1].textured);
  EXPECT_EQ(mesh.parts[1].colour, (std::array{0.1, 0.2, 0.05}));
  EXPECT_EQ(mesh.parts[1].triangles.size(), 3u) << "one of three corners, and one of four";
  EXPECT_EQ(mesh.nodes, 5) << "vertices of two parts at one place";
  EXPECT_EQ(mesh.triangles(), 5u);
  EXPECT_FLOAT_EQ(mesh.position[1].x(), 0.01f);
  EXPECT_FLOAT_EQ(mesh.image[1].x(), 1);
  EXPECT_FLOAT_EQ(mesh.image[1].y(), 0.75f) << "an OBJ counts from below";
}

TEST(ObjFile, WithoutMaterialsWhatHasTextureCoordinatesWearsTheImage) {
  const TestFolder folder;
  VisualSpec spec = spec_in(folder, kObj, "");
  const VisualMesh mesh = load_visual_mesh(spec);
  ASSERT_EQ(mesh.parts.size(), 2u);
  EXPECT_TRUE(mesh.parts[0].textured);
  EXPECT_FALSE(mesh.parts[1].textured);
  EXPECT_FALSE(mesh.parts[1].colour);
  spec.texture.clear();
  EXPECT_FALSE(load_visual_mesh(spec).parts[0].textured);
}

TEST(ObjFile, WhatIsWrittenIsReadBack) {
  const TestFolder folder;
  const VisualMesh mesh = ellipsoid_around({0.05, 0.04, 0.03});
  write_obj(mesh, folder.path("a.obj"), 1e-3, 3);
  write_mtl(mesh, folder.path("a.mtl"), "a.png");
  const ObjMaterials materials = load_mtl(folder.path("a.mtl"));
  const VisualMesh read = load_obj(folder.path("a.obj"), 1e-3, materials, true);
  ASSERT_EQ(read.parts.size(), mesh.parts.size());
  EXPECT_EQ(read.nodes, mesh.nodes);
  for (std::size_t p = 0; p < mesh.parts.size(); ++p) {
    EXPECT_EQ(read.parts[p].material, mesh.parts[p].material);
    EXPECT_EQ(read.parts[p].colour, mesh.parts[p].colour);
    EXPECT_EQ(read.parts[p].textured, mesh.parts[p].textured);
    ASSERT_EQ(read.parts[p].triangles.size(), mesh.parts[p].triangles.size());
    for (std::size_t t = 0; t < read.parts[p].triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int v = read.parts[p].first + read.parts[p].triangles[t][k];
        const int w = mesh.parts[p].first + mesh.parts[p].triangles[t][k];
        EXPECT_LT((read.position[v] - mesh.position[w]).norm(), 1e-6f);
        if (mesh.parts[p].textured) {
          EXPECT_LT((read.image[v] - mesh.image[w]).norm(), 1e-4f);
        }
      }
  }
}

struct Refused {
  const char *find, *replace, *sentence;
};

TEST(ObjFile, RefusesWhatIsNoSurfaceWithTheLine) {
  const TestFolder folder;
  const Refused cases[] = {
      {"v 10 0 0", "v 10 nan 0", ":4: \"nan\" stands where a finite number should"},
      {"v 10 0 0", "v 10 0", ":4: \"\" stands where a finite number should"},
      {"v 10 0 0", "v 1e42 0 0", ":4: a place lies too far away to be drawn"},
      {"vt 1 1", "vt one 1", ":10: \"one\" stands where a finite number should"},
      {"f 1 2 5", "f 1 2 6", ":17: a face asks for number 6 of 5 vertices above it"},
      {"f 1 2 5", "f 1 2 0", ":17: a face asks for number 0 of 5 vertices above it"},
      {"f 1 2 5", "f 1 2", ":17: a face has 2 corners, and needs 3"},
      {"f 1 2 5", "f 1 2 5x", ":17: \"5x\" stands where a face's corner should"},
      {"f 1/1/1 2", "f 1/4/1 2", ":14: a face asks for number 4 of 3 texture coordinates above it"},
      {"usemtl gall bladder", "usemtl spleen", ":17: the material 'spleen' is not in the file of materials"},
  };
  for (const Refused& r : cases) {
    std::string text = kObj;
    text.replace(text.find(r.find), std::string_view(r.find).size(), r.replace);
    const VisualSpec spec = spec_in(folder, text, kMaterials);
    EXPECT_EQ(sentence_of([&] { load_visual_mesh(spec); }), spec.surface.string() + r.sentence) << r.replace;
  }
  VisualSpec spec = spec_in(folder, "v 0 0 0\n", "");
  EXPECT_EQ(sentence_of([&] { load_visual_mesh(spec); }), spec.surface.string() + ":1: the file ends without a face");
  spec = spec_in(folder, kObj, kMaterials);
  spec.texture.clear();
  EXPECT_EQ(sentence_of([&] { load_visual_mesh(spec); }),
            spec.surface.string() + ":14: the material 'liver' wears an image: name it as the scene's 'texture'");
}

TEST(ObjFile, RefusesWhatIsNoListOfMaterialsWithTheLine) {
  const TestFolder folder;
  const Refused cases[] = {
      {"Kd 0.1 0.2 0.05", "Kd 0.1 0.2", ":5: \"\" stands where a finite number should"},
      {"Kd 0.1 0.2 0.05", "Kd 0.1 20 0.05", ":5: a colour goes from 0 to 1, not to 20"},
      {"newmtl gall bladder", "newmtl", ":4: a material has no name"},
      {"newmtl gall bladder", "newmtl liver", ":4: a second material is named 'liver'"},
      {"newmtl liver\n", "\n", ":3: map_Kd stands before the first newmtl"},
  };
  for (const Refused& r : cases) {
    std::string text = kMaterials;
    text.replace(text.find(r.find), std::string_view(r.find).size(), r.replace);
    const auto file = folder.write("bad.mtl", text);
    EXPECT_EQ(sentence_of([&] { load_mtl(file); }), file.string() + r.sentence) << r.replace;
  }
  const auto file = folder.write("none.mtl", "# nothing\n");
  EXPECT_EQ(sentence_of([&] { load_mtl(file); }), file.string() + ": there is no material in it");
}

}  // namespace
}  // namespace palpate
