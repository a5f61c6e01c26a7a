#include "common/models/moving/fading_loads.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kFading = 0.02;  // [s]

}  // namespace

int fading_ticks(double dt) {
  return std::max(1, static_cast<int>(std::lround(kFading / dt)));
}

void FadingLoads::fade(DynamicModel& model) {
  for (const Load& l : loads_) model.set_load(l.node, Eigen::Vector3d::Zero());
  std::erase_if(loads_, [](Load& l) { return --l.ticks_left <= 0; });
  for (const Load& l : loads_)
    model.set_load(l.node, model.load(l.node) + static_cast<double>(l.ticks_left) / ticks_ * l.force);
}

bool FadingLoads::fits(int nodes) const {
  return std::ranges::all_of(loads_, [&](const Load& l) {
    return l.node >= 0 && l.node < nodes && l.ticks_left > 0 && l.ticks_left <= ticks_;
  });
}

}  // namespace palpate
