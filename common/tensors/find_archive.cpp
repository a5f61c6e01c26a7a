#include "common/tensors/find_archive.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "common/tensors/content_hash.hpp"

namespace palpate {

std::filesystem::path archive_path(const Scene&, const Body& body) {
  return archive_path(body.mesh, body.name, content_hash(body));
}

Archive find_archive(const Scene& scene, const Body& body, ArchivePart part) {
  const std::string hash = content_hash(body);
  const auto file = archive_path(body.mesh, body.name, hash);
  const auto advice = fmt::format("run `palpate precompute {}` first", scene.file.string());
  if (!std::filesystem::exists(file))
    throw std::runtime_error(fmt::format("body '{}' has no archive of tensors yet: {}", body.name, advice));
  try {
    return read_archive(file, part, hash);
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}; {}", error.what(), advice));
  }
}

}  // namespace palpate
