#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>

namespace palpate::testing {

/// Calls `round(i)` for i = 0, 1, ...: `rounds` times, or with PALPATE_LONG_TESTS until the time is over.
template <class Round>
void repeat(int rounds, std::chrono::seconds in_long_tests, Round&& round) {
  using Clock = std::chrono::steady_clock;
  const bool for_long = std::getenv("PALPATE_LONG_TESTS") != nullptr;
  const auto end = Clock::now() + in_long_tests;
  for (int i = 0; for_long ? Clock::now() < end : i < rounds; ++i) round(i);
}

/// The same in nine minutes that so many cases share. Each suite has nine.
template <class Round>
void fuzz(int rounds, int cases, Round&& round) {
  repeat(rounds, std::chrono::seconds(9 * 60) / cases, round);
}

/// Where programs break: numbers that are none, that are not what was meant, that end a type.
inline constexpr std::array kExtremeNumbers{std::numeric_limits<double>::quiet_NaN(),
                                            std::numeric_limits<double>::infinity(),
                                            -std::numeric_limits<double>::infinity(),
                                            1.7e308,
                                            -1.7e308,
                                            1e30,
                                            -1e30,
                                            1e6,
                                            -1e6,
                                            1.0,
                                            -1.0,
                                            0.0,
                                            -0.0,
                                            1e-30,
                                            5e-324};
inline constexpr std::array<std::int32_t, 9> kExtremeIntegers{std::numeric_limits<std::int32_t>::min(),
                                                              std::numeric_limits<std::int32_t>::max(),
                                                              -1,
                                                              0,
                                                              1,
                                                              2,
                                                              1 << 16,
                                                              1 << 24,
                                                              1 << 29};

template <class Values>
auto any_of(const Values& values, std::mt19937& random) {
  return values[random() % std::size(values)];
}

}  // namespace palpate::testing
