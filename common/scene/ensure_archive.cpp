#include "common/scene/ensure_archive.hpp"

#include <chrono>
#include <functional>
#include <optional>

#include "common/fem/stopwatch.hpp"
#include "common/mesh/shell_file.hpp"
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

/// Bodies that are led into this one may have changed, of which its archive knows nothing. `mesh`: gives its wall.
template <class Mesh>
void check_guests_of(const Scene& scene, const Body& body, Mesh&& mesh) {
  if (const ShellSpec* wall = wall_of(body)) check_guests(scene, *wall, mesh(*wall));
}

ShellMesh stored_wall(const Archive& archive) {
  return {archive.surface.position, archive.surface.triangles, {}};
}

}  // namespace

void check_guests(const Scene& scene, const ShellSpec& wall, const ShellMesh& mesh) {
  for (const Body& body : scene.bodies) std::visit([&](const auto& spec) { check_guest(spec, wall, mesh); }, body);
}

ArchiveState ensure_archive(const Scene& scene, const Body& body, const Progress& progress) {
  ArchiveState state{archive_path(body), false, {}, 0};
  if (state.file.empty()) return {{}, true, {}, 0};
  const std::string hash = archive_hash(body);
  if (std::filesystem::exists(state.file)) {
    state.refused = refusal(state.file, hash);
    state.up_to_date = state.refused.empty();
    const auto stored = [&](const ShellSpec&) { return stored_wall(find_archive(scene, body, ArchivePart::header)); };
    if (state.up_to_date) check_guests_of(scene, body, stored);
    if (state.up_to_date) return state;
  }
  const ArchiveJob job = std::visit([&](const auto& spec) { return archive_job(spec, progress); }, body);
  check_guests_of(scene, body, [](const ShellSpec& duct) { return load_shell_mesh(duct.mesh, duct.scale); });
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
