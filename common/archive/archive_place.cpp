#include "common/archive/archive_place.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <stdexcept>

#include "common/files/user_cache.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// It is there or can be made, and files can be made in it.
bool can_hold_files(const fs::path& folder) {
  std::error_code error;
  const fs::path asked = fs::exists(folder, error) ? folder : folder.parent_path();
  return !error && faccessat(AT_FDCWD, asked.c_str(), W_OK | X_OK, AT_EACCESS) == 0;
}

}  // namespace

fs::path archive_cache() {
  if (auto cache = user_cache()) return *std::move(cache);
  throw std::runtime_error("no folder for archives of tensors: set PALPATE_CACHE to one, or HOME");
}

fs::path archive_path(const fs::path& mesh_file, const std::string& body, const std::string& content_hash) {
  const std::string name = body + "-" + content_hash + ".h5";
  if (const auto cache = chosen_cache()) return *cache / name;
  const fs::path beside = fs::absolute(mesh_file).parent_path() / ".palpate";
  std::error_code error;
  return fs::exists(beside / name, error) || can_hold_files(beside) ? beside / name : archive_cache() / name;
}

}  // namespace palpate
