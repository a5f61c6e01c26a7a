#include "common/describe/range.hpp"

#include <fmt/format.h>

#include <cmath>

namespace palpate {

std::string Range::words() const {
  std::string from = fmt::format("{} {}", low_allowed ? "at least" : "greater than", low);
  if (std::isinf(high)) return from;
  return fmt::format("{} and {} {}", from, high_allowed ? "at most" : "less than", high);
}

std::string Range::signs() const {
  if (low_allowed && high_allowed && !std::isinf(high)) return fmt::format(", {} to {}", low, high);
  std::string from = fmt::format(" {} {}", low_allowed ? "≥" : ">", low);
  if (std::isinf(high)) return from;
  return fmt::format("{}, {} {}", from, high_allowed ? "≤" : "<", high);
}

}  // namespace palpate
