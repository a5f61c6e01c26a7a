#include "common/tool/hand_motion.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {}  // namespace

void HandMotion::stand(const ToolDofs& at) {
  led_ = first_ = smooth_ = pose_values(at);
  left_ = 0;
  pedal_ = at.pedal;
}

void HandMotion::aim(const ToolDofs& target) {
  const PoseValues to = pose_values(target);
  pedal_ = target.pedal;
  const double lever = std::max(std::abs(led_[2]), std::abs(to[2]));
  const double tip = lever * (std::abs(to[0] - led_[0]) + std::abs(to[1] - led_[1])) + std::abs(to[2] - led_[2]);
  const double turn = std::max(std::abs(to[3] - led_[3]), std::abs(to[4] - led_[4]));
  const double seconds = std::max({bounds_.delay, tip / bounds_.speed, turn / bounds_.turn});
  left_ = std::max(1, static_cast<int>(std::ceil(seconds / dt_)));
  for (std::size_t i = 0; i < to.size(); ++i) pace_[i] = (to[i] - led_[i]) / left_;
}

ToolDofs HandMotion::step() {
  const double share = 1 - std::exp(-dt_ / kSmoothing);
  for (std::size_t i = 0; i < led_.size(); ++i) {
    if (left_ > 0) led_[i] += pace_[i];
    first_[i] += share * (led_[i] - first_[i]);
    smooth_[i] += share * (first_[i] - smooth_[i]);
  }
  left_ = std::max(0, left_ - 1);
  return dofs_of(smooth_, pedal_);
}

}  // namespace palpate
