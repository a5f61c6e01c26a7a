#include "common/describe/value_text.hpp"

#include <fmt/format.h>

namespace palpate::value_text {

std::string number(double x) {
  std::string text = fmt::format("{}", x);
  if (text.find_first_of(".en") == text.npos) text += ".0";
  return text;
}

std::string vector(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", number(v.x()), number(v.y()), number(v.z()));
}

std::string text(std::string_view s) {
  std::string out = "\"";
  for (unsigned char c : s) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += static_cast<char>(c);
    } else if (c < 0x20 || c == 0x7f) {
      out += fmt::format("\\u{:04x}", c);
    } else {
      out += static_cast<char>(c);
    }
  }
  return out + '"';
}

std::string list(const std::vector<std::string>& entries) {
  std::string text;
  for (const std::string& entry : entries) text.append(text.empty() ? "[" : ", ").append(entry);
  return text.empty() ? "[]" : text + "]";
}

std::string box(const Box& box) {
  return fmt::format("[{}, {}]", vector(box.min), vector(box.max));
}

std::string axes(const std::array<bool, 3>& axes) {
  std::string letters;
  for (int axis = 0; axis < 3; ++axis)
    if (axes[axis]) letters += "xyz"[axis];
  return text(letters);
}

std::string indices(const std::vector<int>& indices) {
  std::vector<std::string> entries;
  for (int index : indices) entries.push_back(std::to_string(index));
  return list(entries);
}

}  // namespace palpate::value_text
