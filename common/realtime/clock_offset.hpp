#pragma once
#include <cstdint>
#include <deque>
#include <optional>

namespace palpate {

/// What one question and its answer tell of two clocks [ns]: sent and returned on the own clock, received and
/// answered on the other.
struct ClockExchange {
  std::int64_t sent = 0, received = 0, answered = 0, returned = 0;
};

/// Offset of another clock, other minus own, from exchanges over ways of any delay.
///
/// A message takes no less than no time, whichever way it goes, so that each exchange bounds the offset:
///   answered - returned <= offset <= received - sent.
/// Two clocks drift by a constant rate but for a slow wander: the offsets a + b t that keep within all bounds of the
/// last half minute are a polygon in (a, b), and their range at a time t is the estimate with its uncertainty.
/// Unlike half the round trip it holds for ways of unequal delay too. Exchanges that contradict each other, after one
/// clock was set anew, drop the older ones.
class ClockOffset {
 public:
  static constexpr int kKept = 240;          ///< exchanges
  static constexpr double kMaxDrift = 1e-3;  ///< [1] between two clocks
  static constexpr double kWander = 1e-6;    ///< [1] by which a bound is loosened with its age

  struct Estimate {
    std::int64_t offset_ns = 0;               ///< other minus own
    std::int64_t uncertainty_ns = 0;          ///< the true offset is within so much of it
    double drift = 0, drift_uncertainty = 0;  ///< [1] by which the other clock runs faster
  };

  void add(const ClockExchange& exchange);
  /// At a time of the own clock [ns]; empty before the first exchange.
  std::optional<Estimate> at(std::int64_t own_ns) const;
  std::int64_t round_trip_ns() const { return round_trip_; }  ///< of the last exchange, without the answerer's time

 private:
  struct Bound {
    std::int64_t time, value;  ///< [ns] own clock; offset
  };
  struct Range {
    double low, high;
  };
  Range at_drift(double drift, std::int64_t time) const;
  bool consistent() const;

  std::deque<Bound> upper_, lower_;
  std::int64_t round_trip_ = 0;
};

}  // namespace palpate
