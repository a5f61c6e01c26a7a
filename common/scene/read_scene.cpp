#include <fmt/format.h>

#include <Eigen/Geometry>
#include <fstream>
#include <set>
#include <sstream>

#include "common/scene/read_body.hpp"
#include "common/scene/scene.hpp"
#include "common/scene/table_reader.hpp"

namespace palpate {

namespace {

const Range kPositive = above(0);

bool parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.normalized().cross(b.normalized()).norm() < 1e-6;
}

Contact read_contact(const TableReader& table) {
  Contact contact;
  table.choice("rule", contact.rule, {"barycentric", "alpha"});
  table.number("friction", contact.friction, at_least(0));
  table.number("bucket_size", contact.bucket_size, at_least(0));
  return contact;
}

Passivity read_passivity(const TableReader& table) {
  Passivity passivity;
  table.flag("controller", passivity.controller);
  table.number("reserve", passivity.reserve, at_least(0));
  return passivity;
}

Network read_network(const TableReader& table) {
  Network network;
  table.integer("domain", network.domain, 0, 230);
  table.text("interface", network.interface);
  table.texts("peers", network.peers);
  if (const auto security = table.table("security", "[network.security]"))
    security->path("keys", network.security.emplace().keys, Need::required);
  return network;
}

Rates read_rates(const TableReader& table) {
  Rates rates;
  table.number("haptic_hz", rates.haptic_hz, within(1, 20000));
  table.number("visual_hz", rates.visual_hz, within(1, 1000));
  return rates;
}

Record read_record(const TableReader& table) {
  Record record;
  table.path("file", record.file, Need::required);
  return record;
}

Camera read_camera(const TableReader& table) {
  Camera camera;
  table.vector("eye", camera.eye);
  table.vector("target", camera.target);
  table.vector("up", camera.up);
  table.number("field_of_view", camera.field_of_view, within(1, 170));
  const Eigen::Vector3d view = camera.target - camera.eye;
  if (!(view.stableNorm() > 0)) table.fail("the camera's eye and target must not coincide");
  if (!(camera.up.stableNorm() > 0) || parallel(camera.up.stableNormalized(), view.stableNormalized()))
    table.fail_at("up", "up must be a direction across the camera's line of sight");
  return camera;
}

Render read_render(const TableReader& table) {
  Render render;
  table.integer("width", render.width, 16, 8192);
  table.integer("height", render.height, 16, 8192);
  if (const auto camera = table.table("camera", "[render.camera]")) render.camera = read_camera(*camera);
  table.choice("colour", render.colour, {"tissue", "displacement"});
  Eigen::Vector3d colour(render.tissue_colour[0], render.tissue_colour[1], render.tissue_colour[2]);
  table.vector("tissue_colour", colour);
  if ((colour.array() < 0).any() || (colour.array() > 1).any())
    table.fail_at("tissue_colour", "tissue_colour must be red, green and blue between 0 and 1");
  render.tissue_colour = {colour[0], colour[1], colour[2]};
  table.existing_file("backdrop", render.backdrop);
  table.number("backdrop_scale", render.backdrop_scale, kPositive);
  if (table.has("backdrop_scale") && !table.has("backdrop"))
    table.fail_at("backdrop_scale", "backdrop_scale means nothing without 'backdrop'");
  table.flag("overlay", render.overlay);
  return render;
}

/// Reads a list of named tables whose names must differ.
template <class Item>
void read_named(const TableReader& root, std::string_view key, std::string_view name, Item (*read)(const TableReader&),
                std::vector<Item>& items) {
  std::set<std::string> names;
  for (const TableReader& table : root.tables(key, name)) {
    items.push_back(read(table));
    if (!names.insert(items.back().name).second)
      table.fail_at("name", fmt::format("a second {} is named '{}'", key, items.back().name));
  }
}

Scene read_root(const TableReader& root) {
  Scene scene;
  root.text("title", scene.title);
  read_named(root, "body", "[[body]]", read_body, scene.bodies);
  if (scene.bodies.empty()) root.fail("the scene has no [[body]]");
  check_ducts(root.tables("body", "[[body]]"), scene);
  read_named(root, "tool", "[[tool]]", read_tool, scene.tools);
  if (const auto table = root.table("contact", "[contact]")) scene.contact = read_contact(*table);
  if (const auto table = root.table("passivity", "[passivity]")) scene.passivity = read_passivity(*table);
  if (const auto table = root.table("network", "[network]")) scene.network = read_network(*table);
  if (const auto table = root.table("rates", "[rates]")) scene.rates = read_rates(*table);
  if (const auto table = root.table("record", "[record]")) scene.record = read_record(*table);
  if (const auto table = root.table("render", "[render]")) scene.render = read_render(*table);
  return scene;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& file) {
  toml::table table;
  try {
    table = toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    const auto where = error.source().begin;
    throw std::runtime_error(fmt::format("{}:{}:{}: {}", file.string(), where.line, where.column, error.description()));
  }
  Scene scene = read_root(TableReader(table, "scene", file));
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
