#include <gtest/gtest.h>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using testing::expect_refusal;
using testing::LoopbackScene;
using testing::program;
using testing::replaced;
using testing::text_of;

/// A good scene that one thing spoils.
class ToolsBadBody : public ::testing::Test {
 protected:
  void replace(const std::string& from, const std::string& to) {
    scene_.write("scene.toml", replaced(text_of(scene_.scene()), from, to));
  }

  /// Whoever reads the scene refuses it with the same place and reason.
  void expect_scene_refused(const std::vector<std::string>& fragments) {
    for (const char* start :
         {"palpate check", "palpate precompute", "palpate run", "haptic_node", "deform_node", "render_node"})
      expect_refusal(program(start) + " " + scene_.scene(), fragments);
  }
  void expect_mesh_refused(const std::vector<std::string>& fragments) {
    for (const char* command : {"check", "precompute", "run"})
      expect_refusal(fmt::format("{} {} {}", program("palpate"), command, scene_.scene()), fragments);
    expect_refusal(fmt::format("{} solve {} --method direct --hold 200:0,0,0.001", program("palpate"), scene_.scene()),
                   fragments);
  }

  LoopbackScene scene_{"bad-body"};
};

TEST_F(ToolsBadBody, TheSceneIsGoodBeforeItIsSpoiled) {
  EXPECT_EQ(testing::run_program(program("palpate check") + " " + scene_.scene()).status, 0);
}

TEST_F(ToolsBadBody, ACheckSaysWhatTouchesHowAndWhatTheTensorsAreFrom) {
  const auto says = [&](const std::string& sentence) {
    const auto said = testing::run_program(program("palpate check") + " " + scene_.scene());
    EXPECT_EQ(said.status, 0) << said.err;
    return said.out.find(sentence) != std::string::npos;
  };
  const std::string patch = "each by a patch of its own", chosen = "chosen, since linear ones bend too stiffly";
  EXPECT_TRUE(says(patch));
  EXPECT_TRUE(says("quadratic tetrahedra") && says(chosen));
  replace("[[tool]]\n", "[body.offline]\nelement = \"p1\"\n[[tool]]\n");
  EXPECT_TRUE(says("linear tetrahedra") && !says(chosen));
  replace("[render]\n", "[contact]\nrule = \"barycentric\"\n[render]\n");
  EXPECT_FALSE(says(patch));
}

TEST_F(ToolsBadBody, AMissingMeshIsNamedWithItsLine) {
  std::filesystem::remove(scene_.folder() / "block.msh");
  expect_scene_refused({"scene.toml:4:8: ", "block.msh", "is not a file that can be read"});
}

TEST_F(ToolsBadBody, AMalformedMeshIsNamedWithItsReason) {
  const std::string whole = text_of(scene_.folder() / "block.msh");
  scene_.write("block.msh", whole.substr(0, whole.size() / 3));
  expect_mesh_refused({"block.msh: "});
  scene_.write("block.msh", "this is no mesh\n");
  expect_mesh_refused({"block.msh: "});
}

TEST_F(ToolsBadBody, AMissingSceneIsNamed) {
  std::filesystem::remove(scene_.scene());
  expect_scene_refused({"scene.toml", "is not a file that can be read"});
}

TEST_F(ToolsBadBody, ASyntaxErrorIsGivenWithLineAndColumn) {
  replace("poisson = 0.4", "poisson = = 0.4");
  expect_scene_refused({"scene.toml:7:11: "});
}

TEST_F(ToolsBadBody, AnUnknownKeyIsGivenWithLineAndColumn) {
  replace("poisson", "poison");
  expect_scene_refused({"scene.toml:7:1: unknown key 'poison'"});
}

TEST_F(ToolsBadBody, AnIncompressibleBodyIsRefused) {
  replace("poisson = 0.4", "poisson = 0.5");
  expect_scene_refused({"scene.toml:7:11: poisson ", "less than 0.5"});
}

TEST_F(ToolsBadBody, ANegativeYoungsModulusIsRefused) {
  replace("young = 5000", "young = -5000");
  expect_scene_refused({"scene.toml:6:9: young ", "greater than 0"});
}

TEST_F(ToolsBadBody, ABodyThatIsNotFixedIsRefused) {
  replace("[[body.fixed]]\nbox = [[-1.0, -1.0, -0.0501], [1.0, 1.0, -0.0499]]\n", "");
  expect_scene_refused({"scene.toml:", "body 'block' is not fixed anywhere"});
}

TEST_F(ToolsBadBody, AFixedBoxWithoutANodeIsRefused) {
  replace("-0.0501], [1.0", "-9.0], [1.0");
  replace("1.0, -0.0499]]", "1.0, -8.0]]");
  expect_mesh_refused({"block"});
}

TEST_F(ToolsBadBody, AHoldThatCannotBeIsRefused) {
  const auto refused = [&](const std::string& hold, const std::vector<std::string>& fragments) {
    for (const char* method : {"direct", "tensors"})
      expect_refusal(
          fmt::format("{} solve {} --method {} --hold \"{}\"", program("palpate"), scene_.scene(), method, hold),
          fragments);
  };
  refused("0:0,0,0.001", {"node 0 cannot be held", "it is fixed"});
  refused("400:0,high,0", {"400:0,high,0", "'high' is not a number"});
  refused("400:0,0,nan", {"400:0,0,nan", "'nan'"});
  refused("some:0,0,0", {"--hold", "the mesh has no group 'some'"});
  refused("400", {"400"});
  refused("400:,,", {"400:,,"});
  refused("405:0,0,0.001", {"node 405 is not in the mesh", "405 nodes"});
  refused("-1:0,0,0.001", {"-1"});
}

}  // namespace
}  // namespace palpate
