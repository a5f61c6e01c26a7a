#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <vector>

#include "common/describe/description.hpp"

namespace palpate {

/// Linear viscoelasticity by a Prony series. All moduli fall alike, Poisson's ratio stays:
///   E(t) = E0 (1 - sum of shares[i] (1 - exp(-t / times[i])))
/// a time t after a step of strain, E0 being the body's `young`: what the tissue shows to a fast press. Long after, E0
/// times one less the sum of the shares is left.
struct Relaxation {
  static constexpr int kMaxTerms = 8;

  std::vector<double> times;   ///< [s] ascending
  std::vector<double> shares;  ///< [1] their sum is less than 1
};

inline void describe(Description& d, Relaxation& r) {
  d.numbers({"times", "s", "relaxation times τ, ascending, at most 8", Need::required}, r.times, above(0));
  d.numbers({"shares", "1", "share g of `young` that is lost with each of them; together less than 1", Need::required},
            r.shares, strictly_within(0, 1));
  d.require(r.times.size() <= Relaxation::kMaxTerms, "times",
            fmt::format("times must be {} at most, and are {}", Relaxation::kMaxTerms, r.times.size()));
  d.require(std::ranges::is_sorted(r.times, std::less_equal{}), "times", "times must ascend");
  d.require(r.shares.size() == r.times.size(), "shares",
            fmt::format("shares must be as many as times, {}, and are {}", r.times.size(), r.shares.size()));
  const double sum = std::accumulate(r.shares.begin(), r.shares.end(), 0.0);
  d.require(sum < 1, "shares", fmt::format("shares must together be less than 1, and are {}", sum));
}

}  // namespace palpate
