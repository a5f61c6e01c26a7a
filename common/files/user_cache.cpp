#include "common/files/user_cache.hpp"

#include <cstdlib>

namespace palpate {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> variable(const char* name) {
  const char* value = std::getenv(name);
  return value && *value ? std::optional<fs::path>(value) : std::nullopt;
}

}  // namespace

std::optional<fs::path> chosen_cache() {
  return variable("PALPATE_CACHE");
}

std::optional<fs::path> user_cache() {
  if (auto cache = chosen_cache()) return cache;
  if (const auto caches = variable("XDG_CACHE_HOME")) return *caches / "palpate";
  if (const auto home = variable("HOME")) return *home / ".cache" / "palpate";
  return {};
}

}  // namespace palpate
