#pragma once
#include <array>
#include <cstdint>

namespace palpate {

/// Histogram of durations [ns] in bins that grow with the value: 32 per octave, so that a percentile is right
/// to 3 %. Fixed memory; record() neither allocates nor fails. Used by one thread; copy it to hand it over.
class Histogram {
 public:
  void record(std::int64_t ns);  ///< negative values count as 0, those above about 1 hour as that
  void merge(const Histogram& other);
  void clear() { *this = Histogram(); }

  std::uint64_t count() const { return count_; }
  std::int64_t max() const { return max_; }  ///< [ns] exact, 0 without samples
  std::int64_t min() const { return count_ > 0 ? min_ : 0; }
  double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0; }  ///< [ns]

  /// The value [ns] below which the given share (0..1) of the samples lies: middle of its bin, at most max().
  std::int64_t percentile(double share) const;

  static constexpr int kSubBits = 5;
  static constexpr int kOctaves = 42 - kSubBits;
  static constexpr std::size_t kBins = (kOctaves + 1) << kSubBits;
  /// Number of samples in a bin, and the bin's lowest value [ns]: for plots.
  std::uint64_t in_bin(std::size_t bin) const { return bins_[bin]; }
  static std::int64_t bin_start(std::size_t bin);

 private:
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double sum_ = 0;
  std::int64_t min_ = INT64_MAX, max_ = 0;
};

/// The figures by which latencies are reported [us].
struct Percentiles {
  double p50 = 0, p90 = 0, p99 = 0, p999 = 0, max = 0;
};
Percentiles percentiles_us(const Histogram& histogram);

}  // namespace palpate
