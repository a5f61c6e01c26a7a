#include "tools/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "common/bus/roles.hpp"
#include "common/bus/security.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/models/check/check.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/find_archive.hpp"
#include "common/scene/scene_changes.hpp"
#include "common/tool/instrument.hpp"
#include "render_node/image.hpp"
#include "tools/check_tool.hpp"
#include "tools/mesh/check_mesh.hpp"
#include "tools/node_plan.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/human_bytes.hpp"
#include "tools/shared/set_option.hpp"
#include "tools/tool_warnings.hpp"

namespace palpate {
namespace {

void say_archive(const Scene& scene, const Body& body, CheckOutput& out) {
  const auto file = archive_path(body);
  if (file.empty()) return;
  if (!std::filesystem::exists(file)) {
    out.say("  archive: not computed yet, `palpate precompute` does it");
    return;
  }
  try {
    find_archive(scene, body, ArchivePart::header);
    out.say(fmt::format("  archive: {} ({})", file.string(), human_bytes(std::filesystem::file_size(file))));
  } catch (const std::exception& error) {
    out.say(fmt::format("  archive: refused and to be rebuilt, because {}", error.what()));
  }
}

/// Empty if there is none or it is refused, which say_archive() says.
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

/// The parts of a body's memory in the nodes that `palpate run` starts for the scene, and on disk.
std::vector<MemoryPart> of_nodes(const NodePlan& plan, std::vector<MemoryPart> parts) {
  const std::vector<std::string> nodes = plan.names();
  for (MemoryPart& part : parts)
    if (part.owner == "render_node --deform" && plan.deform) part.owner = "deform_node";  // which superposes then
  std::erase_if(parts, [&](const MemoryPart& part) {
    return part.owner != "disk" && std::ranges::find(nodes, part.owner) == nodes.end();
  });
  return parts;
}

/// Throws std::runtime_error if the picture that a visual surface wears is damaged.
void check_texture(const Body& body) {
  const VisualSpec* visual = visual_of(body);
  if (visual && !visual->texture.empty()) read_png(visual->texture);
}

/// Loads and validates a body's mesh and everything that refers to it.
CheckReport check_body(const Scene& scene, const Body& body, CheckOutput& out) {
  const CheckSettings settings{
      .contact = scene.contact,
      .tools = scene.tools,
      .script = [](const Tool& tool) { return script_of(tool.device); },
      .dt = 1 / scene.rates.haptic_hz,
      .stored = [&](ArchivePart part) { return stored_archive(scene, body, part); },
      .find_wall = [&](const std::string& name) { return find_wall(scene, name); },
      .check_guests = [&](const ShellSpec& wall, const ShellMesh& mesh) { check_guests(scene, wall, mesh); }};
  CheckReport report{.say = [&out](const std::string& line) { out.say(line); }};
  std::visit([&](const auto& spec) { check(spec, settings, report); }, body);
  check_texture(body);  // its size is known to be within bounds by now
  say_archive(scene, body, out);
  out.memory(of_nodes(plan_nodes(scene, {}), report.memory));
  return report;
}

/// Keys are made apart from the scene, and a host may have those of its own nodes alone.
void say_keys(const std::filesystem::path& folder, CheckOutput& out) {
  if (!std::filesystem::is_directory(folder)) {
    out.say(fmt::format("  keys: {} is not there, so that no node starts; `palpate keys` makes it", folder.string()));
    return;
  }
  out.say("  keys: " + folder.string());
  for (const std::string& role : bus_roles()) try {
      out.say(fmt::format("    {}: until {}", role, last_day(find_keys(folder, role))));
    } catch (const std::runtime_error& error) {
      out.say(fmt::format("    {}: none, {}", role, std::string_view(error.what()).substr(9)));  // without "network: "
    }
}

void say_sections(const Scene& scene, CheckOutput& out) {
  out.say(fmt::format("contact: {} rule, friction {}", word_of(scene.contact.rule), scene.contact.friction));
  out.say(fmt::format("rates: haptic {} Hz, visual {} Hz", scene.rates.haptic_hz, scene.rates.visual_hz));
  out.say(fmt::format("network: domain {}, {}", scene.network.domain,
                      scene.network.interface.empty() ? "loopback" : scene.network.interface));
  if (scene.network.security) say_keys(scene.network.security->keys, out);
  if (scene.record) out.say("record: " + scene.record->file.string());
  if (!scene.render) return;
  out.say(fmt::format("render: {} x {}, coloured by {}", scene.render->width, scene.render->height,
                      word_of(scene.render->colour)));
  if (scene.render->backdrop.empty()) return;
  const TriangleMesh backdrop = load_triangle_mesh(scene.render->backdrop, scene.render->backdrop_scale);
  out.say(fmt::format(
      "  backdrop: {} triangles, {}", backdrop.triangles.size(),
      human_bytes(backdrop.nodes.size() * sizeof(Eigen::Vector3f) + backdrop.triangles.size() * 3 * sizeof(int))));
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

void say_left_out(const Scene& scene, std::span<const CheckReport> bodies, CheckOutput& out) {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const std::string& what : bodies[b].left_out)
      out.left_out(fmt::format("body '{}': {}", name_of(scene.bodies[b]), what));
  for (const std::string_view sentence : absences<Body>(scene.bodies)) out.left_out(sentence);
  const auto works = [](const Tool& tool) { return abilities_of(tool).works(); };
  if (std::ranges::none_of(scene.tools, works)) out.left_out("no cautery and no jaws");
  if (scene.tools.empty()) out.left_out("no tool: nothing is felt; `palpate drive --seconds` lets its tissue move");
  for (const std::string_view sentence : absences<DeviceSpec>(devices_of(scene))) out.left_out(sentence);
  if (!scene.record) out.left_out("no [record]: no recorder and no log file");
  if (!scene.network.security)
    out.left_out("no [network.security]: no keys and no encryption; whoever is on the network can take part");
  out.left_out("no render node and no picture, unless a film or a still is asked for");
  if (!scene.render || scene.render->backdrop.empty()) out.left_out("no backdrop");
  if (!has_moving_tissue(scene)) out.left_out("no surface topic, unless a deformation node of its own is asked for");
}

void warn_all(std::span<const std::string> warnings, CheckOutput& out) {
  for (const std::string& sentence : warnings) out.warn(sentence);
}

void check_tools(const Scene& scene, std::span<const CheckReport> bodies, CheckOutput& out) try {
  for (const Tool& tool : scene.tools) {
    out.about("tools", tool.name);
    check_tool(scene, tool, bodies, out);
  }
} catch (const std::exception&) {
  for (const CheckReport& body : bodies) warn_all(body.warnings, out);  // they may say why
  throw;
}

}  // namespace

void check_scene(const Scene& scene, CheckOutput& out) {
  if (!scene.title.empty()) out.fact("title", scene.title, scene.title);
  out.fact("scene", scene.file.string(), "scene " + scene.file.string());
  std::vector<CheckReport> bodies;
  for (const Body& body : scene.bodies) {
    out.about("bodies", name_of(body));
    bodies.push_back(check_body(scene, body, out));
  }
  check_tools(scene, bodies, out);
  out.about("", "");
  out.nodes(plan_nodes(scene, {}).names());
  say_sections(scene, out);
  say_left_out(scene, bodies, out);
  for (const CheckReport& body : bodies) warn_all(body.warnings, out);
  warn_all(tool_warnings(scene), out);
  warn_all(reach_warnings(scene, bodies), out);
  out.fact("hash", scene_hash(scene), "hash " + scene_hash(scene));
}

void add_check_command(cli::Command& app) {
  cli::Command command =
      app.add_command("check", "Validate a scene, or a mesh, and say what will be built and what it takes");
  struct Arguments {
    std::string scene;
    std::vector<std::string> set;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  command.add_option("SCENE", arguments->scene, "Scene file, or a mesh of tetrahedra in metres (.msh, .vtk)")
      .required();
  add_set_option(command, arguments->set);
  command.add_flag("--json", arguments->json, "Print one line of JSON");
  command.examples({"palpate check scenes/liver.toml", "palpate check scenes/liver.toml --set body.young=8000",
                    "palpate check scenes/meshes/liver.msh"});
  command.does([arguments] {
    CheckOutput out(arguments->json);
    if (names_image(arguments->scene))
      throw std::runtime_error(
          arguments->scene +
          " is an image: `palpate organ` makes a mesh of a labelled one, and `palpate segment` labels one");
    if (names_mesh(arguments->scene) && !arguments->set.empty())
      throw std::runtime_error("--set is for a scene, and " + arguments->scene + " is a mesh");
    if (names_mesh(arguments->scene))
      check_mesh(arguments->scene, out);
    else
      check_scene(load_scene(arguments->scene, parse_changes(arguments->set)), out);
    if (arguments->json)
      fmt::print("{}\n", out.json().dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  });
}

}  // namespace palpate
