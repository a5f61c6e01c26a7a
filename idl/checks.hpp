#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <ranges>
#include <string>

/// What the generated checks of messages are made of.
namespace palpate::checks {

inline constexpr std::int64_t kMaxTimeNs = 2'000'000'000'000'000'000;  ///< two may be added and a third taken off
inline constexpr std::size_t kMaxText = 1048576;                       ///< [bytes]
inline constexpr double kMaxNumber = 1e12;  ///< in SI units: the product of two is a number in single precision too

template <class Sequence, class Condition>
bool each(const Sequence& sequence, Condition&& condition) {
  return std::all_of(sequence.begin(), sequence.end(), condition);
}

bool finite(std::floating_point auto value) {
  return std::abs(value) <= kMaxNumber;  // not so of what is no number
}
bool finite(const std::ranges::range auto& values) {
  return each(values, [](auto value) { return finite(value); });
}

inline bool time(std::int64_t value) {
  return value >= -kMaxTimeNs && value <= kMaxTimeNs;
}
bool time(const std::ranges::range auto& values) {
  return each(values, [](std::int64_t value) { return time(value); });
}
inline bool short_enough(const std::string& text) {
  return text.size() <= kMaxText;
}
inline bool unit(const std::array<double, 3>& n) {
  return std::abs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-6;
}

}  // namespace palpate::checks
