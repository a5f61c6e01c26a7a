#include <gtest/gtest.h>

#include "common/scene/scene.hpp"

namespace palpate {
namespace {

TEST(ExampleScenes, AreComplete) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PALPATE_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const Scene scene = load_scene(entry.path());
    EXPECT_FALSE(scene.title.empty()) << entry.path();
    EXPECT_EQ(to_toml(parse_scene(to_toml(scene), entry.path())), to_toml(scene));
    ++scenes;
  }
  EXPECT_GE(scenes, 5);
}

}  // namespace
}  // namespace palpate
