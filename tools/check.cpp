#include "common/models/check/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "common/bus/roles.hpp"
#include "common/bus/security.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/find_archive.hpp"
#include "common/tool/instrument.hpp"
#include "tools/check_tool.hpp"
#include "tools/commands.hpp"
#include "tools/human_bytes.hpp"
#include "tools/tool_warnings.hpp"

namespace palpate {
namespace {

void print_archive(const Scene& scene, const Body& body) {
  const auto file = archive_path(body);
  if (file.empty()) return;
  if (!std::filesystem::exists(file)) {
    fmt::print("  archive: not computed yet, `palpate precompute` does it\n");
    return;
  }
  try {
    find_archive(scene, body, ArchivePart::header);
    fmt::print("  archive: {} ({})\n", file.string(), human_bytes(std::filesystem::file_size(file)));
  } catch (const std::exception& error) {
    fmt::print("  archive: refused and to be rebuilt, because {}\n", error.what());
  }
}

/// Empty if there is none or it is refused, which print_archive() says.
std::optional<Archive> stored_archive(const Scene& scene, const Body& body, ArchivePart part) {
  const auto file = archive_path(body);
  if (file.empty() || !std::filesystem::exists(file)) return {};
  try {
    return find_archive(scene, body, part);
  } catch (const std::exception&) {
    return {};
  }
}

const ShellSpec* find_wall(const Scene& scene, const std::string& name) {
  const auto body = std::ranges::find_if(scene.bodies, [&](const Body& b) { return name_of(b) == name; });
  return body == scene.bodies.end() ? nullptr : wall_of(*body);
}

/// Loads and validates a body's mesh and everything that refers to it.
CheckReport check_body(const Scene& scene, const Body& body) {
  const CheckSettings settings{
      .contact = scene.contact,
      .tools = scene.tools,
      .dt = 1 / scene.rates.haptic_hz,
      .stored = [&](ArchivePart part) { return stored_archive(scene, body, part); },
      .find_wall = [&](const std::string& name) { return find_wall(scene, name); },
      .check_guests = [&](const ShellSpec& wall, const ShellMesh& mesh) { check_guests(scene, wall, mesh); }};
  CheckReport report{.say = [](const std::string& line) { fmt::print("{}\n", line); }};
  std::visit([&](const auto& spec) { check(spec, settings, report); }, body);
  print_archive(scene, body);
  for (const MemoryPart& part : report.memory)
    fmt::print("  {:>10}  {:<20}  {}\n", human_bytes(part.bytes), part.owner, part.what);
  return report;
}

/// Keys are made apart from the scene, and a host may have those of its own nodes alone.
void print_keys(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    fmt::print("  keys: {} is not there, so that no node starts; `palpate keys` makes it\n", folder.string());
    return;
  }
  fmt::print("  keys: {}\n", folder.string());
  for (const std::string& role : bus_roles()) try {
      fmt::print("    {}: until {}\n", role, last_day(find_keys(folder, role)));
    } catch (const std::runtime_error& error) {
      fmt::print("    {}: none, {}\n", role, std::string_view(error.what()).substr(9));  // without "network: "
    }
}

void print_sections(const Scene& scene) {
  fmt::print("contact: {} rule, friction {}\n", scene.contact.rule, scene.contact.friction);
  fmt::print("rates: haptic {} Hz, visual {} Hz\n", scene.rates.haptic_hz, scene.rates.visual_hz);
  fmt::print("network: domain {}, {}\n", scene.network.domain,
             scene.network.interface.empty() ? "loopback" : scene.network.interface);
  if (scene.network.security) print_keys(scene.network.security->keys);
  if (scene.record) fmt::print("record: {}\n", scene.record->file.string());
  if (!scene.render) return;
  fmt::print("render: {} x {}, coloured by {}\n", scene.render->width, scene.render->height, scene.render->colour);
  if (scene.render->backdrop.empty()) return;
  const TriangleMesh backdrop = load_triangle_mesh(scene.render->backdrop, scene.render->backdrop_scale);
  fmt::print(
      "  backdrop: {} triangles, {}\n", backdrop.triangles.size(),
      human_bytes(backdrop.nodes.size() * sizeof(Eigen::Vector3f) + backdrop.triangles.size() * 3 * sizeof(int)));
}

std::vector<DeviceSpec> devices_of(const Scene& scene) {
  std::vector<DeviceSpec> devices;
  for (const Tool& tool : scene.tools) devices.push_back(tool.device);
  return devices;
}

/// Sentences on what is left out where none of `all` is of a kind, in the order of the table of kinds.
template <class Table>
std::vector<std::string_view> absences(const std::vector<Table>& all) {
  std::vector<std::string_view> present, sentences;
  const auto known = [](const std::vector<std::string_view>& list, std::string_view sentence) {
    return std::ranges::find(list, sentence) != list.end();
  };
  for (const Table& one : all) present.push_back(std::visit([](const auto& spec) { return absence(spec); }, one));
  const auto add = [&](std::string_view sentence) {
    if (!sentence.empty() && !known(present, sentence) && !known(sentences, sentence)) sentences.push_back(sentence);
  };
  [&]<std::size_t... Kind>(std::index_sequence<Kind...>) {
    (add(absence(std::variant_alternative_t<Kind, Table>{})), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Table>>{});
  return sentences;
}

void print_left_out(const Scene& scene, std::span<const CheckReport> bodies) {
  fmt::print("left out:\n");
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const std::string& what : bodies[b].left_out) fmt::print("  body '{}': {}\n", name_of(scene.bodies[b]), what);
  for (const std::string_view sentence : absences<Body>(scene.bodies)) fmt::print("  {}\n", sentence);
  const auto works = [](const Tool& tool) { return abilities_of(tool).works(); };
  if (std::ranges::none_of(scene.tools, works)) fmt::print("  no cautery and no jaws\n");
  if (scene.tools.empty()) fmt::print("  no tool: no haptic node\n");
  for (const std::string_view sentence : absences<DeviceSpec>(devices_of(scene))) fmt::print("  {}\n", sentence);
  if (!scene.record) fmt::print("  no [record]: no recorder and no log file\n");
  if (!scene.network.security)
    fmt::print("  no [network.security]: no keys and no encryption; whoever is on the network can take part\n");
  if (!scene.render) fmt::print("  no [render]: default picture\n");
  if (!scene.render || scene.render->backdrop.empty()) fmt::print("  no backdrop\n");
  if (!has_moving_tissue(scene)) fmt::print("  no surface topic, unless a deformation node of its own is asked for\n");
}

void print_warnings(std::span<const std::string> warnings) {
  for (const std::string& sentence : warnings) fmt::print("warning: {}\n", sentence);
}

void check_tools(const Scene& scene, std::span<const CheckReport> bodies) try {
  for (const Tool& tool : scene.tools) check_tool(scene, tool, bodies);
} catch (const std::exception&) {
  for (const CheckReport& body : bodies) print_warnings(body.warnings);  // they may say why
  throw;
}

void check_scene(const Scene& scene) {
  fmt::print("{}{}scene {}\n", scene.title, scene.title.empty() ? "" : "\n", scene.file.string());
  std::vector<CheckReport> bodies;
  for (const Body& body : scene.bodies) bodies.push_back(check_body(scene, body));
  check_tools(scene, bodies);
  print_sections(scene);
  print_left_out(scene, bodies);
  for (const CheckReport& body : bodies) print_warnings(body.warnings);
  print_warnings(tool_warnings(scene));
  print_warnings(reach_warnings(scene, bodies));
  fmt::print("hash {}\n", scene_hash(scene));
}

}  // namespace

void add_check_command(cli::Command& app) {
  cli::Command command = app.add_command("check", "Validate a scene and say what will be built, and what it takes");
  auto file = std::make_shared<std::string>();
  command.add_option("SCENE", *file, "Scene file").required();
  command.examples({"palpate check scenes/liver.toml"});
  command.does([file] { check_scene(load_scene(*file)); });
}

}  // namespace palpate
