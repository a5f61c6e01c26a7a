#pragma once
#include <cstdint>
#include <optional>

#include "web_node/protocol.hpp"

namespace palpate::web {

/// A page that draws is silent, and its hand stands meanwhile: its last sample is said again, for as long as kLongest,
/// so that a page that hangs lets go, and only while its browser answers, so that one that is cut off does. Times [ns].
class StandingHand {
 public:
  static constexpr std::int64_t kApart = 24'000'000;     ///< of a sample and its repetitions
  static constexpr std::int64_t kAnswers = 100'000'000;  ///< a browser within
  static constexpr std::int64_t kLongest = 1'000'000'000;

  /// The page has said something. A sample begins, and what lets the tool go ends.
  void heard(const Said& said, std::int64_t now);
  /// The browser has answered; it does so while its page draws.
  void answered(std::int64_t now) { answered_ = now; }
  bool stands() const { return last_.has_value(); }
  /// The sample to be said now, by the next number; empty once it is over.
  std::optional<Said> again(std::int64_t now);

 private:
  std::optional<Said> last_;
  std::int64_t since_ = 0, answered_ = 0;
};

}  // namespace palpate::web
