#include <gtest/gtest.h>

#include <fstream>

#include "common/scene/scene_changes.hpp"
#include "tests/scene/full_scene.hpp"

namespace palpate {
namespace {

class SceneChanges : public ::testing::Test {
 protected:
  SceneChanges() { std::ofstream(folder_ / "scene.toml") << kFullScene; }

  Scene with(const std::vector<std::string>& arguments) const {
    std::vector<SceneChange> changes;
    for (const std::string& argument : arguments) changes.push_back(parse_change(argument));
    return load_scene(folder_ / "scene.toml", changes);
  }
  std::string refusal(const std::string& argument) const {
    try {
      with({argument});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "not refused";
  }

  SceneFolder folder_;
};

TEST_F(SceneChanges, AreReadAsIfTheFileSaidSo) {
  const Scene plain = load_scene(folder_ / "scene.toml");
  const std::string body = name_of(plain.bodies[0]), tool = plain.tools[0].name;
  const Scene scene = with({"body." + body + ".young=8000", "tool.0.radius=0.0031", "tool." + tool + ".up=[0, 1, 0]",
                            "rates.haptic_hz=1500", "title=\"two words\""});
  EXPECT_EQ(name_of(scene.bodies[0]), body);
  EXPECT_NE(to_toml(scene).find("young = 8000"), std::string::npos);
  EXPECT_NE(to_toml(scene).find("radius = 0.0031"), std::string::npos);
  EXPECT_EQ(scene.rates.haptic_hz, 1500);
  EXPECT_EQ(scene.title, "two words");
  EXPECT_EQ(with({"title=word"}).title, "word") << "a single word needs no quotes";
  EXPECT_EQ(with({"title=first", "title=second"}).title, "second");
  EXPECT_EQ(to_toml(with({})), to_toml(plain));
}

TEST_F(SceneChanges, MakeTheTablesThatTheFileLacks) {
  std::ofstream(folder_ / "scene.toml") << R"(
[[body]]
name = "block"
mesh = "liver.msh"
young = 1e4
poisson = 0.3
[[body.fixed]]
group = "base"
)";
  const Scene scene = with({"contact.friction=0.4", "body.young=2e4"});
  EXPECT_NE(to_toml(scene).find("friction = 0.4"), std::string::npos);
  EXPECT_NE(to_toml(scene).find("young = 20000"), std::string::npos);
}

TEST_F(SceneChanges, AnotherChoiceLetsGoOfTheFilesKeysForTheOldOne) {
  const Scene scene = with({"tool.finger.device=log", "tool.finger.trajectory=session.lcmlog"});
  EXPECT_EQ(std::get<LogDeviceSpec>(scene.tools[4].device).trajectory, folder_ / "session.lcmlog")
      << "the file's start, lease and delay are a pointer's";
  EXPECT_NE(refusal("tool.probe.start=[0, 0, 0]").find("start means nothing for the device 'scripted'"),
            std::string::npos);
  try {
    with({"tool.finger.device=bus", "tool.finger.start=[0, 0, 0]"});
    ADD_FAILURE() << "what a change asks for is never let go";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("start means nothing for the device 'bus'"), std::string::npos);
  }
}

TEST_F(SceneChanges, AreRefusedWithTheirOwnPlace) {
  const std::string body = name_of(load_scene(folder_ / "scene.toml").bodies[0]);
  EXPECT_EQ(refusal("body." + body + ".young=-1"),
            "--set body." + body + ".young=-1: young must be greater than 0 and at most 1e+20, and is -1");
  EXPECT_EQ(refusal("body." + body + ".yung=1").find("--set body." + body + ".yung=1: unknown key 'yung'"), 0u);
  EXPECT_NE(refusal("body.young=1").find("entries of 'body': name one of " + body), std::string::npos);
  EXPECT_NE(refusal("body.77.young=1").find("name one of"), std::string::npos);
  EXPECT_EQ(refusal("title.x=1"), "--set title.x=1: 'title' is a value, not a table with keys");
  EXPECT_EQ(refusal("rates.haptic_hz=fast"), "--set rates.haptic_hz=fast: haptic_hz must be a number, not a string");
  EXPECT_EQ(refusal("rates.haptic_hz=nan"), "--set rates.haptic_hz=nan: haptic_hz must be finite");
  EXPECT_NE(refusal("rates.haptic_hz=[1").find("--set rates.haptic_hz=[1: "), std::string::npos);
  EXPECT_EQ(refusal("title=1\n[x]"), "--set title=1\n[x]: give one value");
  EXPECT_NE(refusal("=1").find("give KEY=VALUE"), std::string::npos);
  EXPECT_NE(refusal("title").find("give KEY=VALUE"), std::string::npos);
  EXPECT_NE(refusal("title=").find("give KEY=VALUE"), std::string::npos);
  EXPECT_NE(refusal(std::string(5000, 'x') + "=1").find("longer than"), std::string::npos);
  EXPECT_NE(refusal("." + std::string(2000, '.') + "=1").find("unknown key"), std::string::npos);
  EXPECT_NE(refusal("title=" + std::string(3000, '[')), "not refused");
}

}  // namespace
}  // namespace palpate
