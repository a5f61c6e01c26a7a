#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "common/scene/scene.hpp"
#include "common/scene/scene_reader.hpp"

namespace palpate {

const KeyList& scene_keys() {
  static const KeyList keys = [] {
    KeyList list;
    Scene scene;
    describe(list, scene);
    return list;
  }();
  return keys;
}

Scene parse_scene(std::string_view text, const std::filesystem::path& file) {
  toml::table table;
  try {
    table = toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    const auto where = error.source().begin;
    throw std::runtime_error(fmt::format("{}:{}:{}: {}", file.string(), where.line, where.column, error.description()));
  }
  Scene scene;
  SceneReader reader(table, scene_keys(), file);
  describe(reader, scene);
  scene.file = std::filesystem::absolute(file).lexically_normal();
  return scene;
}

Scene load_scene(const std::filesystem::path& file) {
  std::error_code error;
  std::ifstream stream(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file, error) || !stream)
    throw std::runtime_error(fmt::format("{}:1:1: the scene is not a file that can be read", file.string()));
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_scene(text.str(), file);
}

}  // namespace palpate
