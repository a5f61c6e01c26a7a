#include "common/sim/handling.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kPlaceInterval = 0.02;  // [s] shorter ones measure the device's resolution
constexpr double kGap = 1;               // [s] after which the places begin anew
constexpr double kSameTouch = 0.05;      // [s]
constexpr double kRounding = 1e-6;       // [s] of times in nanoseconds since long ago: logs come to what runs came to

}  // namespace

void Handling::look(double time, const Eigen::Vector3d& tip, const Eigen::Vector3d& force) {
  if (!begun_) {
    begun_ = true;
    begin_ = time_ = next_place_ = time;
    set_out_ = tip_ = place_.back() = tip;
    force_ = force;
  }
  take_places(time, tip);
  const double dt = time - time_, size = force.norm();
  time_ = time;
  sum_.max_change = std::max(sum_.max_change, (force - force_).norm());
  sum_.max_force = std::max(sum_.max_force, size);
  sum_.impulse += size * dt;
  if (size > 0) sum_.touching += dt;
  tip_ = tip;
  force_ = force;
  note_touch(time, tip, size > 0);
}

// Between steps, so that the places are as far apart in time as they are said to be.
void Handling::take_places(double time, const Eigen::Vector3d& tip) {
  if (time - next_place_ > kGap) places_ = 0, next_place_ = time;
  for (; next_place_ <= time + kRounding; next_place_ += kPlaceInterval)
    take_place(time > time_ ? tip_ + (next_place_ - time_) / (time - time_) * (tip - tip_) : tip);
}

void Handling::take_place(const Eigen::Vector3d& tip) {
  const double way = (tip - place_.back()).norm();
  sum_.path += way;
  if (!touches_) air_ += way;
  std::rotate(place_.begin(), place_.begin() + 1, place_.end());
  place_.back() = tip;
  if (++places_ < static_cast<int>(place_.size())) return;
  const Eigen::Vector3d third = place_[3] - 3 * place_[2] + 3 * place_[1] - place_[0];
  jerk_squares_ += third.squaredNorm() / std::pow(kPlaceInterval, 6);
  ++jerks_;
}

void Handling::note_touch(double time, const Eigen::Vector3d& tip, bool touches) {
  if (touches) last_touch_ = time;
  if (touches && !touches_) {
    touches_ = true;
    ++sum_.touches;
    straight_ += (tip - set_out_).norm();
  }
  if (!touches_ || time - last_touch_ < kSameTouch - kRounding) return;
  touches_ = false;
  set_out_ = tip;
}

HandlingFigures Handling::figures() const {
  HandlingFigures all = sum_;
  all.seconds = time_ - begin_;
  all.jerk = jerks_ > 0 ? std::sqrt(jerk_squares_ / jerks_) : 0;
  all.mean_force = all.touching > 0 ? all.impulse / all.touching : 0;
  const double straight = straight_ + (touches_ ? 0 : (tip_ - set_out_).norm());
  all.economy = air_ > 0 ? std::min(1.0, straight / air_) : 1;
  return all;
}

}  // namespace palpate
