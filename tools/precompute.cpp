#include <fmt/format.h>

#include <cstdio>

#include "common/scene/ensure_archive.hpp"
#include "common/scene/scene.hpp"
#include "tools/commands.hpp"

namespace palpate {
namespace {

void show_stage(std::string_view stage, double seconds) {
  constexpr double kWorthSaying = 0.1;
  if (seconds >= kWorthSaying) fmt::print(stderr, "  {:<40} {:8.2f} s\n", stage, seconds);
}

void describe(const Archive& archive, const ArchiveState& state) {
  const double megabytes = 1e-6 * static_cast<double>(std::filesystem::file_size(state.file));
  fmt::print("  {} nodes, {} of them touchable; {} touchable dofs, {} others; {:.1f} MB\n", archive.surface.size(),
             archive.surface.touchable, archive.touchable_dofs.size(), archive.other_dofs.size(), megabytes);
}

void precompute_body(const Scene& scene, const Body& body) {
  const auto state = ensure_archive(scene, body, show_stage);
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
  const auto more = [&](const auto& spec) { return archive_lines(spec, archive); };
  for (const std::string& line : std::visit(more, body)) fmt::print("  {}\n", line);
}

}  // namespace

void add_precompute_command(cli::Command& app) {
  cli::Command command = app.add_command("precompute", "Compute the tensors of every body of a scene, once");
  auto file = std::make_shared<std::string>();
  command.add_option("SCENE", *file, "Scene file").required();
  command.examples({"palpate precompute scenes/liver.toml"});
  command.does([file] {
    const Scene scene = load_scene(*file);
    for (const auto& body : scene.bodies) precompute_body(scene, body);
  });
}

}  // namespace palpate
