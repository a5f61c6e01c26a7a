#include "common/scene/find_archive.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/models/content_hash.hpp"

namespace palpate {

std::filesystem::path archive_path(const Body& body) {
  const std::filesystem::path mesh = std::visit([](const auto& spec) { return mesh_file(spec); }, body);
  return mesh.empty() ? mesh : archive_path(mesh, name_of(body), archive_hash(body));
}

Archive find_archive(const Scene& scene, const Body& body, ArchivePart part) {
  if (auto made = std::visit([](const auto& spec) { return made_archive(spec); }, body)) {
    made->content_hash = content_hash(body);
    return std::move(*made);
  }
  const auto file = archive_path(body);
  const auto advice = fmt::format("run `palpate precompute {}` first", scene.file.string());
  if (!std::filesystem::exists(file))
    throw std::runtime_error(fmt::format("body '{}' has no archive of tensors yet: {}", name_of(body), advice));
  try {
    Archive archive = read_archive(file, part, archive_hash(body));
    if (archive.model != kind_of(body)) throw std::runtime_error(file.string() + ": made for another kind of tissue");
    std::visit([&](const auto& spec) { fit_archive(spec, archive); }, body);
    archive.content_hash = content_hash(body);
    return archive;
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}; {}", error.what(), advice));
  }
}

}  // namespace palpate
