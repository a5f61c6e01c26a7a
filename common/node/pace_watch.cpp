#include "common/node/pace_watch.hpp"

#include <fmt/format.h>

#include <utility>

namespace palpate {
namespace {

constexpr double kTooMany = 0.1;  // of what was to be done
constexpr int kLooks = 2;

}  // namespace

void PaceWatch::look(std::uint64_t done, std::uint64_t missed) {
  const auto now_done = static_cast<double>(done - std::exchange(done_, done));
  const auto now_missed = static_cast<double>(missed - std::exchange(missed_, missed));
  const double share = now_missed > 0 ? now_missed / (now_done + now_missed) : 0;
  late_ = share > kTooMany ? late_ + 1 : 0;
  const bool was_behind = !status_.empty();
  status_.clear();
  news_.clear();
  if (late_ >= kLooks) {
    ++looks_behind_;
    status_ =
        fmt::format("{} falls behind by {:.0f} %: {}; this machine has too much to do", what_, 100 * share, means_);
  }
  if (late_ == kLooks) news_ = status_;
  if (was_behind && late_ == 0) news_ = fmt::format("{} keeps up again", what_);
}

}  // namespace palpate
