#pragma once
#include <fmt/format.h>

#include <cstdint>
#include <string>

namespace palpate {

/// Bytes as a person reads them: "1.2 MB".
inline std::string human_bytes(std::uintmax_t bytes) {
  const double b = static_cast<double>(bytes);
  if (b < 1e6) return fmt::format("{:.1f} kB", b * 1e-3);
  return b < 1e9 ? fmt::format("{:.1f} MB", b * 1e-6) : fmt::format("{:.2f} GB", b * 1e-9);
}

}  // namespace palpate
