#pragma once
#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace palpate {

/// Walks through the bytes of a mesh file and takes numbers off it, as text or as binary.
/// Every function throws std::runtime_error with a reason where the file does not go on as asked.
class FileCursor {
 public:
  explicit FileCursor(std::string_view bytes) : bytes_(bytes) {}

  bool binary = false;   ///< how number() reads
  bool swapped = false;  ///< binary numbers have the other byte order

  std::size_t left() const { return bytes_.size() - at_; }

  /// Moves behind the next line that begins with `word`; false where there is none. `word` ends in a line's
  /// end or a blank.
  bool seek_line(std::string_view word) {
    for (std::size_t from = at_;; ++from) {
      from = bytes_.find(word, from);
      if (from == std::string_view::npos) return false;
      const std::size_t end = from + word.size();
      const bool starts = from == 0 || bytes_[from - 1] == '\n';
      if (!starts || (end < bytes_.size() && !is_blank(bytes_[end]))) continue;
      at_ = end;
      return true;
    }
  }

  /// The rest of the line, without its end; the cursor goes to the next line.
  std::string_view rest_of_line() {
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    std::string_view line = bytes_.substr(at_, end - at_);
    at_ = std::min(end + 1, bytes_.size());
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  std::string_view word() {
    while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_])) ++at_;
    if (begin == at_) throw std::runtime_error("the file ends too early");
    return bytes_.substr(begin, at_ - begin);
  }

  /// A number in words, whatever `binary` says. T: an integer type, float or double.
  template <class T>
  T text_number() {
    std::string_view text = word();
    if (text.size() > 1 && text[0] == '+') text.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      throw std::runtime_error("\"" + printable(text) + "\" stands where a number should");
    }
    return value;
  }

  template <class T>
  T number() {
    if (!binary) return text_number<T>();
    if (left() < sizeof(T)) throw std::runtime_error("the file ends too early");
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + at_, sizeof(T));
    if (swapped) std::reverse(raw, raw + sizeof(T));
    at_ += sizeof(T);
    return std::bit_cast<T>(raw);
  }

  /// A count of things that still have to come, so there cannot be more of them than bytes.
  template <class T>
  std::size_t count(std::string_view things) {
    return checked_count(number<T>(), things);
  }
  std::size_t text_count(std::string_view things) { return checked_count(text_number<long long>(), things); }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

  static std::string printable(std::string_view text) {
    std::string shown;
    for (char c : text.substr(0, 20)) shown += c >= 32 && c < 127 ? c : '?';
    return shown;
  }

  template <class T>
  std::size_t checked_count(T value, std::string_view things) {
    if (value < T{0} || static_cast<std::size_t>(value) > left()) {
      throw std::runtime_error("the file announces " + std::to_string(value) + " " + std::string(things) +
                               ", which it is too short to hold");
    }
    return static_cast<std::size_t>(value);
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace palpate
