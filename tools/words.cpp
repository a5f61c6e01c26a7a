#include "tools/words.hpp"

#include <fmt/format.h>

namespace palpate {

std::string human(std::size_t bytes) {
  const double b = static_cast<double>(bytes);
  if (b < 1e6) return fmt::format("{:.1f} kB", b * 1e-3);
  return b < 1e9 ? fmt::format("{:.1f} MB", b * 1e-6) : fmt::format("{:.2f} GB", b * 1e-9);
}

std::string describe(const Selector& where, const char* list) {
  if (!where.group.empty()) return fmt::format("group '{}'", where.group);
  return where.box ? "a box" : fmt::format("a list of {}", list);
}

}  // namespace palpate
