#pragma once
#include <limits>
#include <string>

namespace palpate {

/// Bounds of a number.
struct Range {
  double low, high;
  bool low_allowed, high_allowed;

  bool contains(double x) const { return (low_allowed ? x >= low : x > low) && (high_allowed ? x <= high : x < high); }
  std::string words() const;  ///< "at least 0 and less than 1"
  std::string signs() const;  ///< "≥ 0, < 1"
};

/// low < x
constexpr Range above(double low) {
  return {low, std::numeric_limits<double>::infinity(), false, true};
}
/// low <= x
constexpr Range at_least(double low) {
  return {low, std::numeric_limits<double>::infinity(), true, true};
}
/// low <= x <= high
constexpr Range within(double low, double high) {
  return {low, high, true, true};
}
/// low < x < high
constexpr Range strictly_within(double low, double high) {
  return {low, high, false, false};
}
/// low < x <= high
constexpr Range above_up_to(double low, double high) {
  return {low, high, false, true};
}

}  // namespace palpate
