#pragma once
#include <cstdint>
#include <string>

namespace palpate {

/// Whether a loop keeps up with its own clock, in words. A machine that has too much to do leaves pictures out first,
/// then the tissue's ticks, and the force's steps last, by the loops' priorities.
class PaceWatch {
 public:
  /// `what` falls behind, and what that means: "the picture", "some are left out".
  PaceWatch(std::string what, std::string means) : what_(std::move(what)), means_(std::move(means)) {}

  /// Call about once a second with what has been done and what was left out, both in all. It falls behind where a tenth
  /// was left out twice in a row, and has caught up with the first look at which it was not.
  void look(std::uint64_t done, std::uint64_t missed);

  std::uint64_t looks_behind() const { return looks_behind_; }  ///< in all
  const std::string& status() const { return status_; }         ///< empty: it keeps up
  /// For the log: as it begins to fall behind, and when it has caught up. Empty without news.
  const std::string& news() const { return news_; }

 private:
  std::string what_, means_, status_, news_;
  std::uint64_t done_ = 0, missed_ = 0, looks_behind_ = 0;
  int late_ = 0;  ///< looks in a row
};

}  // namespace palpate
