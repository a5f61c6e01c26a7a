#include "common/realtime/clock_offset.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr int kSteps = 40;  // of a search over the drift

/// Where a concave function is largest.
template <class F>
double summit(double low, double high, F&& value) {
  for (int i = 0; i < kSteps; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (value(a) < value(b))
      low = a;
    else
      high = b;
  }
  return 0.5 * (low + high);
}

/// Where a function goes from positive at `good` to negative towards `bad`; `bad` where it does not.
template <class F>
double border(double good, double bad, F&& value) {
  if (value(bad) >= 0) return bad;
  for (int i = 0; i < kSteps; ++i) {
    const double middle = 0.5 * (good + bad);
    (value(middle) >= 0 ? good : bad) = middle;
  }
  return good;
}

}  // namespace

void ClockOffset::add(const ClockExchange& e) {
  round_trip_ = (e.returned - e.sent) - (e.answered - e.received);
  if (round_trip_ < 0 || e.returned < e.sent) return;  // not of this pair of clocks
  upper_.push_back({e.sent, e.received - e.sent});
  lower_.push_back({e.returned, e.answered - e.returned});
  while (static_cast<int>(upper_.size()) > kKept || (upper_.size() > 1 && !consistent())) {
    upper_.pop_front();
    lower_.pop_front();
  }
}

/// Offsets at a time that keep within the bounds if the clocks drift so; low above high where none does.
ClockOffset::Range ClockOffset::at_drift(double drift, std::int64_t time) const {
  Range range{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const auto moved = [&](const Bound& b) {
    return static_cast<double>(b.value) + drift * static_cast<double>(time - b.time);
  };
  const auto slack = [&](const Bound& b) { return kWander * std::abs(static_cast<double>(time - b.time)); };
  for (const Bound& b : upper_) range.high = std::min(range.high, moved(b) + slack(b));
  for (const Bound& b : lower_) range.low = std::max(range.low, moved(b) - slack(b));
  return range;
}

bool ClockOffset::consistent() const {
  const std::int64_t time = upper_.back().time;
  const auto width = [&](double drift) {
    const Range r = at_drift(drift, time);
    return r.high - r.low;
  };
  return width(summit(-kMaxDrift, kMaxDrift, width)) >= 0;
}

std::optional<ClockOffset::Estimate> ClockOffset::at(std::int64_t own_ns) const {
  if (upper_.empty()) return std::nullopt;
  const auto width = [&](double drift) {
    const Range r = at_drift(drift, own_ns);
    return r.high - r.low;
  };
  const double middle = summit(-kMaxDrift, kMaxDrift, width);
  const double slowest = border(middle, -kMaxDrift, width), fastest = border(middle, kMaxDrift, width);
  const auto highest = [&](double drift) { return at_drift(drift, own_ns).high; };
  const auto lowest = [&](double drift) { return -at_drift(drift, own_ns).low; };
  const double high = highest(summit(slowest, fastest, highest)), low = -lowest(summit(slowest, fastest, lowest));
  return Estimate{.offset_ns = std::llround(0.5 * (low + high)),
                  .uncertainty_ns = static_cast<std::int64_t>(std::ceil(0.5 * std::max(0.0, high - low))) + 1,
                  .drift = 0.5 * (slowest + fastest),
                  .drift_uncertainty = 0.5 * (fastest - slowest)};
}

}  // namespace palpate
