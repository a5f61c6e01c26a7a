#include "common/realtime/histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace palpate {
namespace {

constexpr std::int64_t kMax = (std::int64_t{1} << 42) - 1;

/// Values below 32 have a bin each; above, the five bits below the leading one choose the bin in its octave.
std::size_t bin_of(std::int64_t ns) {
  const auto value = static_cast<std::uint64_t>(std::clamp<std::int64_t>(ns, 0, kMax));
  constexpr int sub = Histogram::kSubBits;
  if (value < (1u << sub)) return value;
  const int octave = std::bit_width(value) - 1 - sub;
  return (static_cast<std::size_t>(octave) << sub) + (value >> octave);
}

}  // namespace

std::int64_t Histogram::bin_start(std::size_t bin) {
  if (bin < (1u << kSubBits)) return static_cast<std::int64_t>(bin);
  const auto octave = (bin >> kSubBits) - 1;
  return static_cast<std::int64_t>((bin - (octave << kSubBits)) << octave);
}

void Histogram::record(std::int64_t ns) {
  ns = std::max<std::int64_t>(ns, 0);
  ++bins_[bin_of(ns)];
  ++count_;
  sum_ += static_cast<double>(ns);
  min_ = std::min(min_, ns);
  max_ = std::max(max_, ns);
}

void Histogram::merge(const Histogram& other) {
  for (std::size_t i = 0; i < kBins; ++i) bins_[i] += other.bins_[i];
  count_ += other.count_;
  sum_ += other.sum_;
  min_ = std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
}

std::int64_t Histogram::percentile(double share) const {
  if (count_ == 0) return 0;
  const auto rank = static_cast<std::uint64_t>(std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    seen += bins_[i];
    if (seen < std::max<std::uint64_t>(rank, 1)) continue;
    const std::int64_t width = i + 1 < kBins ? bin_start(i + 1) - bin_start(i) : 1;
    return std::clamp(bin_start(i) + (width - 1) / 2, min_, max_);
  }
  return max_;
}

Percentiles percentiles_us(const Histogram& h) {
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) / 1000.0; };
  return {us(h.percentile(0.5)), us(h.percentile(0.9)), us(h.percentile(0.99)), us(h.percentile(0.999)), us(h.max())};
}

}  // namespace palpate
