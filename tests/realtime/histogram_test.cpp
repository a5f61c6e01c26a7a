#include "common/realtime/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace palpate {
namespace {

TEST(Histogram, BinsCoverAllValuesWithoutOverlap) {
  for (std::size_t bin = 1; bin < Histogram::kBins; ++bin)
    ASSERT_GT(Histogram::bin_start(bin), Histogram::bin_start(bin - 1)) << bin;
  for (std::int64_t value : {0L, 1L, 31L, 32L, 33L, 63L, 64L, 1000L, 123456789L, (1L << 42) - 1}) {
    Histogram h;
    h.record(value);
    std::size_t bin = 0;
    while (h.in_bin(bin) == 0) ++bin;
    EXPECT_LE(Histogram::bin_start(bin), value);
    if (bin + 1 < Histogram::kBins) {
      EXPECT_GT(Histogram::bin_start(bin + 1), value);
    }
    EXPECT_EQ(h.percentile(0.5), value);
  }
}

TEST(Histogram, PercentilesAreThoseOfTheSortedValuesToThreePercent) {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> spread(10, 2);
  std::vector<std::int64_t> values(20000);
  Histogram h;
  for (auto& value : values) h.record(value = std::llround(spread(random)));
  std::sort(values.begin(), values.end());
  for (double share : {0.01, 0.5, 0.9, 0.99, 0.999}) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
    const auto exact = static_cast<double>(values[rank]);
    EXPECT_NEAR(static_cast<double>(h.percentile(share)), exact, 0.032 * exact + 1) << share;
  }
  EXPECT_EQ(h.max(), values.back());
  EXPECT_EQ(h.min(), values.front());
  EXPECT_EQ(h.percentile(1), values.back());
}

TEST(Histogram, MergedHistogramsCountAllSamples) {
  Histogram a, b;
  for (int i = 0; i < 100; ++i) a.record(10), b.record(1000);
  a.merge(b);
  EXPECT_EQ(a.count(), 200u);
  EXPECT_EQ(a.percentile(0.25), 10);
  EXPECT_NEAR(static_cast<double>(a.percentile(0.75)), 1000, 32);
  EXPECT_EQ(a.min(), 10);
  EXPECT_EQ(a.max(), 1000);
}

TEST(Histogram, ValuesOutsideTheRangeAreCountedAtItsEnds) {
  Histogram h;
  h.record(-5);
  h.record(INT64_MAX);
  EXPECT_EQ(h.count(), 2u);
  EXPECT_EQ(h.min(), 0);
  EXPECT_EQ(h.max(), INT64_MAX);
  EXPECT_EQ(Histogram().percentile(0.5), 0);
}

}  // namespace
}  // namespace palpate
