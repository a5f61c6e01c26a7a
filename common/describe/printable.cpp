#include "common/describe/printable.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace palpate {
namespace {

constexpr char32_t kNone = 0xffffffff;

/// Characters from the first to the last that are not shown: control, separators, direction and what shows nothing.
constexpr std::pair<char32_t, char32_t> kHidden[] = {
    {0x00, 0x1f},     {0x7f, 0x9f},     {0xad, 0xad},     {0x61c, 0x61c},   {0x180e, 0x180e},   {0x200b, 0x200f},
    {0x2028, 0x202e}, {0x2060, 0x206f}, {0xfeff, 0xfeff}, {0xfff9, 0xfffb}, {0xe0000, 0xe0fff},
};

/// The bytes of a character of UTF-8, from its first one; 0: no character begins so.
std::size_t length_from(unsigned char first) {
  if (first < 0x80) return 1;
  if (first < 0xc2) return 0;
  if (first < 0xe0) return 2;
  return first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
}

/// The character of these bytes; kNone if they are none.
char32_t character_of(std::string_view bytes) {
  const std::size_t length = bytes.size();
  const auto first = static_cast<unsigned char>(bytes[0]);
  char32_t c = length == 1 ? first : first & (0xffu >> (length + 1));
  for (const char byte : bytes.substr(1)) {
    if ((byte & 0xc0) != 0x80) return kNone;
    c = c << 6 | (byte & 0x3f);
  }
  const bool longer_than_needed = (length == 3 && c < 0x800) || (length == 4 && c < 0x10000);
  const bool surrogate = c >= 0xd800 && c <= 0xdfff;
  return longer_than_needed || surrogate || c > 0x10ffff ? kNone : c;
}

bool shown(char32_t c) {
  const auto holds = [c](const auto& range) { return c >= range.first && c <= range.second; };
  return c != kNone && std::ranges::none_of(kHidden, holds);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const std::size_t length = length_from(static_cast<unsigned char>(text[0]));
    const bool whole = length > 0 && length <= text.size();
    const char32_t c = whole ? character_of(text.substr(0, length)) : kNone;
    const std::size_t taken = c == kNone ? 1 : length;
    line.append(shown(c) ? text.substr(0, taken) : "?");
    text.remove_prefix(taken);
  }
  return line;
}

}  // namespace palpate
