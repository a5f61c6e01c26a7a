#pragma once
#include <string>
#include <string_view>

namespace palpate {

/// Where a table stands: "body.hybrid"; empty for the top of the file.
struct TablePath {
  std::string path;
  bool list = false;

  TablePath below(std::string_view key, bool is_list) const {
    return {path.empty() ? std::string(key) : path + "." + std::string(key), is_list};
  }
  /// As a scene file writes it: `[[body]]`, `[body.shell]`; the top of the file is `scene`.
  std::string name() const {
    if (path.empty()) return "scene";
    return list ? "[[" + path + "]]" : "[" + path + "]";
  }
};

}  // namespace palpate
