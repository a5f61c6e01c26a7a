#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "common/scene/reference.hpp"
#include "common/scene/scene.hpp"

namespace palpate {
namespace {

TEST(SceneReference, ThePageIsWhatTheDescriptionsSay) {
  std::ifstream stream(PALPATE_SOURCE_DIR "/docs/scene.md");
  std::ostringstream page;
  page << stream.rdbuf();
  EXPECT_EQ(page.str(), with_reference(page.str(), scene_keys())) << "write it anew: scene_reference docs/scene.md";
}

TEST(SceneReference, EveryTableOfKeysIsOnThePage) {
  EXPECT_THROW(with_reference("## `scene`: the top\n\n| key |\n", scene_keys()), std::runtime_error);
}

TEST(SceneReference, AKeyOfSomeKindsSaysOfWhich) {
  const KeyList& keys = scene_keys();
  const DescribedKey* shell = keys.find("body")->find("shell");
  ASSERT_TRUE(shell);
  EXPECT_EQ(shell->kinds, std::vector<std::string>{"modal_shell"});
  EXPECT_EQ(keys.find("body")->find("poisson")->fallback, "needed; 0.45 for `catheter`");
  EXPECT_EQ(keys.find("contact")->find("friction")->type, "number ≥ 0");
  EXPECT_EQ(keys.find("contact")->find("friction")->fallback, "0.3");
}

}  // namespace
}  // namespace palpate
