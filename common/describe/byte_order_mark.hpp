#pragma once
#include <string_view>

namespace palpate {

/// A text file without the mark by which some programs begin UTF-8.
inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

}  // namespace palpate
