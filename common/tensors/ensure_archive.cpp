#include "common/tensors/ensure_archive.hpp"

#include <chrono>
#include <functional>
#include <optional>

#include "common/fem/stopwatch.hpp"
#include "common/mesh/mesh_file.hpp"
#include "common/mesh/shell_file.hpp"
#include "common/shell/fixation.hpp"
#include "common/tensors/content_hash.hpp"
#include "common/tensors/find_archive.hpp"
#include "common/tensors/precompute.hpp"
#include "common/tensors/precompute_dynamic.hpp"
#include "common/tensors/precompute_shell.hpp"

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

std::optional<TetMesh> load_specimen(const Body& body) {
  if (!body.nonlinear || body.nonlinear->specimen_mesh.empty()) return {};
  return load_tet_mesh(body.nonlinear->specimen_mesh, body.nonlinear->specimen_scale);
}

Archive compute(const Body& body, const TetMesh& mesh, const Progress& progress) {
  if (body.hybrid && !body.hybrid->mesh.empty()) {
    const auto coarse = load_tet_mesh(body.hybrid->mesh, body.hybrid->scale);
    return precompute_dynamic(body, mesh, &coarse, progress);
  }
  const auto specimen = load_specimen(body);
  return precompute(body, mesh, specimen ? &*specimen : nullptr, progress);
}

/// The computation for a body's mesh, which is loaded here.
std::function<Archive()> load_job(const Scene& scene, const Body& body, const Progress& progress) {
  if (body.model != "modal_shell")
    return [&, mesh = load_tet_mesh(body.mesh, body.scale)] { return compute(body, mesh, progress); };
  auto mesh = load_shell_mesh(body.mesh, body.scale);
  check_duct(scene, body, mesh);
  return [&, mesh = std::move(mesh)] { return precompute_shell(body, mesh, progress); };
}

/// The catheters may have changed, of which the archive knows nothing.
ShellMesh wall_of(const Archive& archive) {
  return {archive.surface.position, archive.surface.triangles, {}};
}

}  // namespace

ArchiveState ensure_archive(const Scene& scene, const Body& body, const Progress& progress) {
  if (body.model == "catheter") return {{}, true, {}, 0};
  const std::string hash = content_hash(body);
  ArchiveState state{archive_path(body.mesh, body.name, hash), false, {}, 0};
  if (std::filesystem::exists(state.file)) {
    state.refused = refusal(state.file, hash);
    state.up_to_date = state.refused.empty();
    if (state.up_to_date && body.shell)
      check_duct(scene, body, wall_of(find_archive(scene, body, ArchivePart::header)));
    if (state.up_to_date) return state;
  }
  const auto job = load_job(scene, body, progress);
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
