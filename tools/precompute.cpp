#include <fmt/format.h>

#include <cstdio>
#include <numbers>

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

void describe_moving_part(const Archive& archive) {
  if (archive.tetrahedra.empty()) return;
  fmt::print("  {} tetrahedra that move with inertia\n", archive.tetrahedra.size());
  if (!archive.hybrid) return;
  const HybridTensors& hybrid = *archive.hybrid;
  fmt::print("  {} connection nodes to the quasi-static part\n", hybrid.connection.size());
  if (hybrid.held_by_connection)
    fmt::print("  a piece of the quasi-static part has too few fixed nodes: the connection nodes hold it\n");
  if (!hybrid.gap.empty())
    fmt::print("  partial connection: {} nodes of the border are not shared, the gap is up to {:.3g} m at rest\n",
               hybrid.gap.size(), hybrid.max_gap);
}

void describe_modes(const Archive& archive) {
  if (!archive.modal) return;
  const auto& omega = archive.modal->omega;
  fmt::print("  {} modes of {:.4g} to {:.4g} Hz\n", omega.size(), omega.front() / (2 * std::numbers::pi),
             omega.back() / (2 * std::numbers::pi));
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
  describe_moving_part(archive);
  describe_modes(archive);
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
