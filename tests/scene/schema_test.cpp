#include <gtest/gtest.h>

#include "tests/scene/full_scene.hpp"

namespace palpate {
namespace {

/// Every key is read: a date, which no key takes, is refused at each, and the sentence names the key.
TEST(SceneRefusal, EveryKeyOfTheSchemaRefusesADate) {
  const SceneFolder folder;
  const std::string body = kMinimalScene, tool = "[[tool]]\nname = \"a\"\npivot = [0, 0, 0]\ndevice = \"bus\"\n";
  int tried = 0;
  for (const DescribedTable& described : scene_keys().tables()) {
    const std::string table = described.path.name();
    for (const DescribedKey& row : described.keys) {
      const std::string& key = row.name;
      const std::string line = key + " = 1979-05-27\n";
      std::string text = kFullScene;
      if (table == "scene") {
        text = line;
        if (key == "tool" || key == "contact" || key == "passivity" || key == "network" || key == "rates" ||
            key == "record" || key == "render" || key == "web")
          text += body;
        if (key == "title") text += body;
      } else {
        // Put the key into the first table of that name, in the place of the line that has it or of nothing.
        const std::string header = table + "\n";
        auto place = text.find(header);
        ASSERT_NE(place, text.npos) << header;
        const std::string plain = "[[body]]\nname = \"a\"\nmesh = \"liver.msh\"\nyoung = 1\npoisson = 0\n";
        const std::string shell = plain + "model = \"modal_shell\"\n";
        const std::string held = plain + "fixed = [{ group = \"a\" }]\n";
        if (key == "security") {
          text = body + "[network]\n" + line;
        } else if (key == "camera") {
          text = body + "[render]\n" + line;
        } else if (key == "rotations") {
          text = shell + "shell = { thickness = 1 }\n[[body.fixed]]\nnodes = [1]\n" + line;
        } else if (key == "shell") {
          text = held + "model = \"modal_shell\"\n" + line;
        } else if (key == "catheter") {
          text = "[[body]]\nname = \"a\"\nmodel = \"catheter\"\nyoung = 1\n" + line;
        } else if (table == "[tool.jaws]" && key != "length" && key != "width" && key != "closed_below") {
          text = body + tool + "kind = \"forceps\"\n[tool.jaws]\n" + line;
        } else if (key == "damping_ratio") {
          text = shell + "fixed = [{ group = \"a\" }]\n[body.shell]\nthickness = 1\n" + line;
        } else if (key == "lease" || key == "start" || key == "delay" || key == "max_speed") {
          const std::string start = key == "start" ? "" : "start = [0, 0, 0]\n";
          text = body + "[[tool]]\nname = \"a\"\npivot = [0, 0, 0]\ndevice = \"pointer\"\n" + start + line;
        } else if (key == "motion_scale") {
          text = body + "[[tool]]\nname = \"a\"\npivot = [0, 0, 0]\ndevice = \"bus\"\n" + line;
        } else if (key == "mass" || (table == "[[tool]]" && (key == "damping" || key == "stiffness"))) {
          text =
              body + "[[tool]]\nname = \"a\"\npivot = [0, 0, 0]\ndevice = \"hand\"\ntrajectory = \"move.csv\"\n" + line;
        } else if (key == "cautery" || key == "jaws" || key == "motion") {
          text = body + tool + line;
        } else if (key == "fixed") {
          text = plain + line;
        } else if (key == "material" || key == "nonlinear" || key == "relaxation" || key == "touchable" ||
                   key == "offline" || key == "visual" || key == "load") {
          text = held + line;
        } else if (key == "ball_radius" || key == "places") {
          text = held + "[body.nonlinear]\nlaw = \"neo_hookean\"\n" + line;
        } else if (key == "dynamic" || key == "tearing" || key == "hybrid") {
          text = held + "model = \"hybrid\"\n" + line;
        } else if (key == "region") {
          text = held + "model = \"hybrid\"\n[body.hybrid]\n" + line;
        } else {
          place += header.size();
          auto end = text.find("\n[", place);
          if (end == text.npos) end = text.size();
          std::string section = "\n" + text.substr(place, end - place);
          const auto old = section.find("\n" + key + " = ");
          const bool selector = key == "nodes" || key == "box" || key == "group" || key == "elements";
          if (old != section.npos) section.erase(old + 1, section.find('\n', old + 1) - old);
          if (selector) section = "\n" + std::string(table == "[[body.material]]" ? "young = 1\n" : "");
          text.replace(place, end - place, section.substr(1) + line);
        }
      }
      const std::string said = refusal(text, folder / "scene.toml");
      EXPECT_NE(said.find(": " + key + " must "), said.npos) << table << " " << key << ": " << said;
      ++tried;
    }
  }
  EXPECT_GT(tried, 110);
}

template <class Device>
void expect_keys_of_one_node() {
  KeyList keys;
  Device device;
  describe(keys, device);
  for (const DescribedTable& table : keys.tables())
    for (const DescribedKey& key : table.keys)
      EXPECT_EQ(key.use, Use::local) << Device::kKind << " " << key.name << ": nodes need not agree on devices";
}

TEST(SceneSchema, NodesNeedNotAgreeOnDevices) {
  []<class... Devices>(std::type_identity<std::variant<Devices...>>) {
    (expect_keys_of_one_node<Devices>(), ...);
  }(std::type_identity<DeviceSpec>());
}

}  // namespace
}  // namespace palpate
