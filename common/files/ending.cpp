#include "common/files/ending.hpp"

#include <algorithm>
#include <cctype>
#include <string>

namespace palpate {

bool has_ending(const std::filesystem::path& file, std::string_view ending) {
  std::string name = file.filename();
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.ends_with(ending);
}

}  // namespace palpate
