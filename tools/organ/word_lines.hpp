#pragma once
#include <string>
#include <string_view>

namespace palpate {

/// The words of a text, line by line. '#' begins a comment, and a '\' at a line's end is a blank: the line goes on in
/// the next one.
class WordLines {
 public:
  explicit WordLines(std::string_view text) : text_(text) {}

  bool next();              ///< goes to the next line; false behind the last
  std::string_view word();  ///< the next one of the line; empty behind its last
  double number();          ///< the next word; throws where it is no finite number

  /// Throws std::runtime_error("line 3: sentence").
  [[noreturn]] void refuse(const std::string& sentence) const;
  [[noreturn]] void refuse_at(int line, const std::string& sentence) const;
  int line() const { return line_; }
  std::size_t left() const { return text_.size() - at_; }

 private:
  std::size_t blank() const;

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0;
};

}  // namespace palpate
