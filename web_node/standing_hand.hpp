#pragma once
#include <cstdint>
#include <optional>

#include "web_node/protocol.hpp"

namespace palpate::web {

/// A page that draws is silent, and its hand stands meanwhile: its last sample is said again, for as long as kLongest,
/// so that a page that hangs lets go, and only while its browser answers, so that one that is cut off does; a browser
/// that answers again is gone on with. Times [ns].
class StandingHand {
 public:
  static constexpr std::int64_t kApart = 24'000'000;     ///< of a sample and its repetitions
  static constexpr std::int64_t kAnswers = 100'000'000;  ///< a browser within
  static constexpr std::int64_t kLongest = 1'000'000'000;

  /// The page has said something. A sample begins, and what lets the tool go ends.
  void heard(const Said& said, std::int64_t now);
  /// The browser has answered; it does so while its page draws.
  void answered(std::int64_t now) { answered_ = now; }
  /// Whether there may be something to be said again, now or later.
  bool stands(std::int64_t now) const { return last_ && now - since_ <= kLongest; }
  /// The sample to be said now, by the next number; empty where it does not stand or its browser is silent.
  std::optional<Said> again(std::int64_t now);

 private:
  std::optional<Said> last_;
  std::int64_t since_ = 0, answered_ = 0;
};

}  // namespace palpate::web
