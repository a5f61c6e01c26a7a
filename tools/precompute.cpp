#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/progress.hpp"
#include "common/scene/ensure_archive.hpp"
#include "common/scene/scene_changes.hpp"
#include "tools/shared/commands.hpp"
#include "tools/shared/set_option.hpp"

namespace palpate {
namespace {

/// What is to be said of an archive of this kind.
std::vector<std::string> lines_of(const Body& body, const Archive& archive) {
  return std::visit([&](const auto& spec) { return archive_lines(spec, archive); }, body);
}

void show_stage(std::string_view stage, double seconds) {
  const double worth = cli::telling() == cli::Telling::everything ? 0 : 0.1;  // [s]
  if (seconds >= worth) cli::say(fmt::format("  {:<40} {:8.2f} s", stage, seconds));
}

void print_json(const Body& body, const ArchiveState& state) {
  nlohmann::ordered_json json{{"body", name_of(body)}, {"model", kind_of(body)}, {"archive", nullptr}};
  if (!state.file.empty()) {
    const auto archive = read_archive(state.file, ArchivePart::header, {});
    json["archive"] = state.file.string();
    json["bytes"] = std::filesystem::file_size(state.file);
    json["up_to_date"] = state.up_to_date;
    json["refused"] = state.refused;
    json["seconds"] = state.up_to_date ? 0.0 : state.seconds;
    json["nodes"] = archive.surface.size();
    json["touchable"] = archive.surface.touchable;
    json["said"] = lines_of(body, archive);
  }
  fmt::print("{}\n", json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void describe(const Archive& archive, const ArchiveState& state) {
  const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(state.file));
  fmt::print("  {} nodes, {} of them touchable; {} touchable dofs, {} others; {:.1f} MB\n", archive.surface.size(),
             archive.surface.touchable, archive.touchable_dofs.size(), archive.other_dofs.size(), megabytes);
}

void print_text(const Body& body, const ArchiveState& state) {
  if (state.file.empty()) {
    fmt::print("body '{}': a {} needs no archive\n", name_of(body), kind_of(body));
    return;
  }
  if (!state.refused.empty()) fmt::print(stderr, "rebuilt, because {}\n", state.refused);
  if (state.up_to_date)
    fmt::print("body '{}': up to date: {}\n", name_of(body), state.file.string());
  else
    fmt::print("body '{}': computed and written in {:.3f} s: {}\n", name_of(body), state.seconds, state.file.string());
  const auto archive = read_archive(state.file, ArchivePart::header, {});
  describe(archive, state);
  for (const std::string& line : lines_of(body, archive)) fmt::print("  {}\n", line);
}

}  // namespace

void add_precompute_command(cli::Command& app) {
  cli::Command command = app.add_command("precompute", "Compute the tensors of every body of a scene, once");
  struct Options {
    std::string scene;
    std::vector<std::string> set;
    bool json = false;
  };
  auto o = std::make_shared<Options>();
  command.add_option("SCENE", o->scene, "Scene file").required();
  add_set_option(command, o->set);
  command.add_flag("--json", o->json, "Print one line of JSON a body");
  command.tells_progress();
  command.examples(
      {"palpate precompute scenes/liver.toml", "palpate precompute scenes/liver.toml --set body.poisson=0.48"});
  command.does([o] {
    const Scene scene = load_scene(o->scene, parse_changes(o->set));
    for (const auto& body : scene.bodies) {
      const ArchiveState state = ensure_archive(scene, body, show_stage);
      o->json ? print_json(body, state) : print_text(body, state);
    }
  });
}

}  // namespace palpate
