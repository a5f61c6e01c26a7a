#include "tools/latency/tissue_course.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

constexpr std::int64_t kOvertakenNs = 1'000'000'000;  // what is older by more is another run's

}  // namespace

void TissueCourse::begin_anew() {
  lost_ns_ = at_once_ns_ = 0;
}

// Messages of several topics may overtake one another; of one tick they say the same.
void TissueCourse::look(std::int64_t tissue_ns, std::int64_t late_ns) {
  const bool overtaken = tissue_ns <= tissue_ns_ && tissue_ns_ - tissue_ns < kOvertakenNs;
  if (tissue_ns == 0 || overtaken) return;
  if (tissue_ns > tissue_ns_ && tissue_ns_ > 0) {
    lost_ns_ += late_ns - late_ns_;
    at_once_ns_ = std::max(at_once_ns_, late_ns - late_ns_);
  }
  tissue_ns_ = tissue_ns;
  late_ns_ = late_ns;
}

std::string text_of(const TissueCourse& tissue) {
  if (!tissue.known()) return "";
  return fmt::format("tissue           at {:.3f} s, {:.4f} s late; lost {:.4f} s meanwhile, {:.4f} s at once at most\n",
                     tissue.time_s(), tissue.late_s(), std::max(tissue.lost_s(), 0.0), tissue.at_once_s());
}

}  // namespace palpate
