#include "tools/study/measure.hpp"

#include <malloc.h>

#include <algorithm>

namespace palpate::study {

std::size_t bytes_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

StepTime summarise(std::vector<double> seconds) {
  if (seconds.empty()) return {};
  std::ranges::sort(seconds);
  const auto at = [&](double share) {
    return seconds[std::min(seconds.size() - 1, static_cast<std::size_t>(share * seconds.size()))];
  };
  return {at(0.5), at(0.99)};
}

}  // namespace palpate::study
