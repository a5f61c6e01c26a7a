#include "common/scene/ensure_archive.hpp"

#include <chrono>
#include <functional>
#include <optional>

#include "common/fem/stopwatch.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/models/catheter/check_duct.hpp"
#include "common/models/content_hash.hpp"
#include "common/scene/find_archive.hpp"

namespace palpate {
namespace {

/// Empty if the file is whole and made for this content, else the reason against it.
std::string refusal(const std::filesystem::path& file, const std::string& hash) {
  try {
    read_archive(file, ArchivePart::surface, hash);
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// Bodies that are led into this one may have changed, of which its archive knows nothing.
template <class Wall>
void check_guests(const Scene& scene, const Body& body, Wall&& wall) {
  const auto* duct = as<ShellSpec>(body);
  if (!duct) return;
  for (const Body& other : scene.bodies)
    if (const auto* wire = as<CatheterSpec>(other); wire && wire->catheter.inside == duct->name)
      check_duct(*wire, *duct, wall(*duct));
}

ShellMesh wall_of(const Archive& archive) {
  return {archive.surface.position, archive.surface.triangles, {}};
}

/// Empty for a body without a mesh.
ArchiveJob load_job(const Body& body, const Progress& progress) {
  const auto load = [&](const auto& spec) -> ArchiveJob {
    if constexpr (std::derived_from<std::remove_cvref_t<decltype(spec)>, MeshedSpec>)
      return archive_job(spec, progress);
    return {};
  };
  return std::visit(load, body);
}

}  // namespace

ArchiveState ensure_archive(const Scene& scene, const Body& body, const Progress& progress) {
  ArchiveState state{archive_path(body), false, {}, 0};
  if (state.file.empty()) return {{}, true, {}, 0};
  const std::string hash = content_hash(body);
  if (std::filesystem::exists(state.file)) {
    state.refused = refusal(state.file, hash);
    state.up_to_date = state.refused.empty();
    const auto stored = [&](const ShellSpec&) { return wall_of(find_archive(scene, body, ArchivePart::header)); };
    if (state.up_to_date) check_guests(scene, body, stored);
    if (state.up_to_date) return state;
  }
  const ArchiveJob job = load_job(body, progress);
  check_guests(scene, body, [](const ShellSpec& duct) { return load_shell_mesh(duct.mesh, duct.scale); });
  const auto begin = std::chrono::steady_clock::now();
  auto archive = job();
  archive.content_hash = hash;
  Stopwatch watch(progress);
  write_archive(archive, state.file);
  watch.lap("writing");
  state.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return state;
}

std::vector<Archive> load_or_precompute(const Scene& scene, ArchivePart part, const Progress& progress) {
  std::vector<Archive> archives;
  for (const auto& body : scene.bodies) {
    ensure_archive(scene, body, progress);
    archives.push_back(find_archive(scene, body, part));
  }
  return archives;
}

}  // namespace palpate
