#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "common/scene/change_table.hpp"
#include "common/scene/moved_files.hpp"
#include "common/scene/scene.hpp"
#include "common/scene/scene_changes.hpp"
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

namespace {

// The parser, and what it made, go into themselves for each part of a dotted key.
void refuse_deep_keys(std::string_view text, const std::filesystem::path& file) {
  constexpr int kMaxDots = 64;
  int line = 1, dots = 0;
  char quote = 0;
  for (const char c : text) {
    line += c == '\n';
    if (c == '\n' || c == quote)
      quote = 0;
    else if (quote == 0 && (c == '"' || c == '\''))
      quote = c;
    if (quote != 0) continue;
    if (c == '.' && ++dots > kMaxDots)
      throw std::runtime_error(fmt::format("{}:{}:1: a key of more than {} parts", file.string(), line, kMaxDots + 1));
    if (std::string_view("\n=,{}[]").find(c) != std::string_view::npos) dots = 0;
  }
}

Scene read(std::string_view text, const std::filesystem::path& file, std::span<const SceneChange> changes,
           const MovedFiles& moved) {
  refuse_deep_keys(text, file);
  toml::table table;
  try {
    table = toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    const auto where = error.source().begin;
    throw std::runtime_error(fmt::format("{}:{}:{}: {}", file.string(), where.line, where.column, error.description()));
  }
  for (const SceneChange& change : changes) change_table(table, change);
  Scene scene;
  SceneReader reader(table, scene_keys(), file, moved);
  describe(reader, scene);
  scene.file = std::filesystem::absolute(file).lexically_normal();
  return scene;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& file) {
  return read(text, file, {}, {});
}

Scene parse_scene(std::string_view text, const std::filesystem::path& file, const MovedFiles& moved) {
  return read(text, file, {}, moved);
}

Scene load_scene(const std::filesystem::path& file) {
  return load_scene(file, {});
}

Scene load_scene(const std::filesystem::path& file, std::span<const SceneChange> changes) {
  std::error_code error;
  std::ifstream stream;
  if (std::filesystem::is_regular_file(file, error)) stream.open(file, std::ios::binary);  // a pipe would wait
  if (!stream.is_open())
    throw std::runtime_error(fmt::format("{}:1:1: the scene is not a file that can be read", file.string()));
  std::ostringstream text;
  text << stream.rdbuf();
  return read(text.str(), file, changes, {});
}

}  // namespace palpate
