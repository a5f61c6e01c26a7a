#include "tools/organ/word_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "common/describe/printable.hpp"

namespace palpate {

/// How many characters here stand between words of a line.
std::size_t WordLines::blank() const {
  const std::string_view ahead = text_.substr(at_, 3);
  if (ahead.starts_with("\\\n")) return 2;
  if (ahead.starts_with("\\\r\n")) return 3;
  return !ahead.empty() && std::string_view(" \t\r\v\f").find(ahead[0]) != std::string_view::npos ? 1 : 0;
}

bool WordLines::next() {
  if (line_ > 0) {
    while (!word().empty()) {
    }
    at_ = std::min(text_.find('\n', at_), text_.size() - 1) + 1;
  }
  ++line_;
  return at_ < text_.size();
}

std::string_view WordLines::word() {
  for (std::size_t count; (count = blank()) > 0; at_ += count) line_ += count > 1;
  const std::size_t begin = at_;
  if (at_ < text_.size() && text_[at_] == '#') return {};
  while (at_ < text_.size() && text_[at_] != '\n' && blank() == 0) ++at_;
  return text_.substr(begin, at_ - begin);
}

double WordLines::number() {
  const std::string_view text = word(), digits = text.starts_with('+') ? text.substr(1) : text;
  if (text.empty()) refuse("it ends where a number should stand");
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    refuse(fmt::format("\"{}\" stands where a finite number should", printable(text.substr(0, 20))));
  return value;
}

void WordLines::refuse(const std::string& sentence) const {
  refuse_at(line_, sentence);
}

void WordLines::refuse_at(int line, const std::string& sentence) const {
  throw std::runtime_error(fmt::format("line {}: {}", line, sentence));
}

}  // namespace palpate
