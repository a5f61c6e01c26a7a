#pragma once
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace palpate {

/// The lines of a text file of words, such as OBJ and MTL; `#` begins a comment.
class TextLines {
 public:
  /// Throws std::runtime_error("FILE: sentence") if it cannot be read, or has more than 256 MiB.
  explicit TextLines(std::filesystem::path file);

  /// Steps to the next line that has a word, which becomes its key; false behind the last.
  bool next();
  std::string_view key() const { return key_; }
  std::string_view word();        ///< the next one of the line; empty behind the last
  std::string_view rest() const;  ///< of the line, without blanks about it
  double number();                ///< the next word; throws where it is no finite number
  std::optional<double> number_if_any();

  /// Throws std::runtime_error("FILE:LINE: sentence").
  [[noreturn]] void refuse(const std::string& sentence) const;

 private:
  std::filesystem::path file_;
  std::string text_;
  std::string_view left_, line_, key_;
  int number_ = 0;
};

}  // namespace palpate
