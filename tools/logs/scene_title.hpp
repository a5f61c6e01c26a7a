#pragma once
#include <string>

namespace palpate {

/// The first `title = "…"` of a TOML text, as the resolved scene writes it.
inline std::string title_of(const std::string& scene) {
  const std::size_t key = scene.find("title");
  if (key == std::string::npos || (key > 0 && scene[key - 1] != '\n')) return {};
  const std::size_t open = scene.find_first_of("'\"", key);
  if (open == std::string::npos) return {};
  const std::size_t close = scene.find(scene[open], open + 1);
  return close == std::string::npos ? std::string() : scene.substr(open + 1, close - open - 1);
}

}  // namespace palpate
