#include "common/mesh/text_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "common/describe/printable.hpp"

namespace palpate {
namespace {

constexpr std::uintmax_t kMaxTextBytes = 256u << 20;
constexpr std::string_view kBlanks = " \t\r\v\f";

std::string contents_of(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw std::runtime_error(fmt::format("{}: the file cannot be read: {}", file.string(), error.message()));
  if (size > kMaxTextBytes)
    throw std::runtime_error(fmt::format("{}: the file has more than {} bytes", file.string(), kMaxTextBytes));
  std::ifstream in(file, std::ios::binary);
  std::string text(size, '\0');
  in.read(text.data(), static_cast<std::streamsize>(size));
  if (in.bad() || static_cast<std::uintmax_t>(in.gcount()) != size)
    throw std::runtime_error(fmt::format("{}: the file cannot be read", file.string()));
  return text;
}

}  // namespace

TextLines::TextLines(std::filesystem::path file) : file_(std::move(file)), text_(contents_of(file_)), left_(text_) {}

bool TextLines::next() {
  while (!left_.empty()) {
    const std::size_t end = left_.find('\n');
    line_ = left_.substr(0, end);
    left_.remove_prefix(end == left_.npos ? left_.size() : end + 1);
    line_ = line_.substr(0, line_.find('#'));
    ++number_;
    key_ = word();
    if (!key_.empty()) return true;
  }
  return false;
}

std::string_view TextLines::word() {
  line_.remove_prefix(std::min(line_.find_first_not_of(kBlanks), line_.size()));
  const std::string_view word = line_.substr(0, line_.find_first_of(kBlanks));
  line_.remove_prefix(word.size());
  return word;
}

std::string_view TextLines::rest() const {
  const std::size_t begin = line_.find_first_not_of(kBlanks);
  if (begin == line_.npos) return {};
  return line_.substr(begin, line_.find_last_not_of(kBlanks) + 1 - begin);
}

double TextLines::number() {
  const std::string_view text = word();
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
    refuse(fmt::format("\"{}\" stands where a finite number should", printable(text.substr(0, 20))));
  return value;
}

std::optional<double> TextLines::number_if_any() {
  if (rest().empty()) return {};
  return number();
}

void TextLines::refuse(const std::string& sentence) const {
  throw std::runtime_error(fmt::format("{}:{}: {}", file_.string(), number_, sentence));
}

}  // namespace palpate
