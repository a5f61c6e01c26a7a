#include "tools/organ/grown_region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/organ/voxel_pieces.hpp"

namespace palpate {
namespace {

constexpr int kAround = 2;         // [voxels] to each side of a seed
constexpr double kTold = 4;        // deviations that are still the organ's
constexpr double kNear = 2;        // [voxels, and blurs] from a border within which values are between its two sides'
constexpr double kShell = 2;       // [voxels] beyond, whose values are the surroundings'
constexpr int kPasses = 8;         // until the range stays
constexpr double kSettled = 0.02;  // of the range's width that it may still change by
constexpr double kFull = 0.95;     // of the image, beyond which a region is no organ
constexpr int kEnough = 20;        // voxels from which a median is taken
constexpr double kOfNormal = 1.4826;  // deviation of a normal distribution, in median distances to its median

double median_of(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

GreyLevel level_of_values(std::vector<float>& values) {
  const double median = median_of(values);
  for (float& v : values) v = static_cast<float>(std::abs(v - median));
  return {median, kOfNormal * median_of(values)};
}

GreyLevel level_around(const ScalarGrid& grey, const std::vector<std::size_t>& seeds) {
  std::vector<float> values;
  for (const std::size_t seed : seeds) {
    const auto middle = grey.shape.voxel_of(seed);
    std::array<int, 3> low, high;
    for (int a = 0; a < 3; ++a) {
      low[a] = std::max(middle[a] - kAround, 0);
      high[a] = std::min(middle[a] + kAround, grey.shape.count[a] - 1);
    }
    for (int k = low[2]; k <= high[2]; ++k)
      for (int j = low[1]; j <= high[1]; ++j)
        for (int i = low[0]; i <= high[0]; ++i) values.push_back(grey.value[grey.shape.index(i, j, k)]);
  }
  return level_of_values(values);
}

std::vector<char> in_range(const ScalarGrid& grey, const GreyRange& range) {
  std::vector<char> inside(grey.value.size());
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = range.holds(grey.value[i]);
  return inside;
}

/// What surrounds a region, by grey values that are not the range's.
struct Surroundings {
  std::vector<float> darker, brighter;
};

Surroundings surroundings_of(const ScalarGrid& grey, const std::vector<char>& inside, double blur, double median,
                             const GreyRange& range) {
  const DistanceGrid distance = distance_to_border(grey.shape, inside);
  const double voxel = grey.shape.spacing.mean(), near = std::max(kNear * voxel, kNear * blur);
  Surroundings around;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (distance.value[i] < near || distance.value[i] > near + kShell * voxel || range.holds(grey.value[i])) continue;
    (grey.value[i] < median ? around.darker : around.brighter).push_back(grey.value[i]);
  }
  return around;
}

/// The range whose ends lie midway from `median` to the medians of what is darker and brighter around; where there is
/// one of the two alone, the other end is as far from it: nothing there needs a sharper one.
GreyRange range_between(Surroundings around, double median, GreyRange range) {
  const bool low = around.darker.size() >= kEnough, high = around.brighter.size() >= kEnough;
  if (low) range.low = 0.5 * (median + median_of(around.darker));
  if (high) range.high = 0.5 * (median + median_of(around.brighter));
  if (low && !high) range.high = std::max(range.high, 2 * median - range.low);
  if (high && !low) range.low = std::min(range.low, 2 * median - range.high);
  return range;
}

std::string say_seed(const GridShape& shape, std::size_t seed) {
  const auto [i, j, k] = shape.voxel_of(seed);
  return fmt::format("the seed at voxel {},{},{}", i, j, k);
}

}  // namespace

GreyLevel level_of(const ScalarGrid& grey, const std::vector<char>& inside) {
  const DistanceGrid distance = distance_to_border(grey.shape, inside);
  const auto deeper_than = [&](double depth) {
    std::vector<float> values;
    for (std::size_t i = 0; i < inside.size(); ++i)
      if (inside[i] && distance.value[i] <= -depth) values.push_back(grey.value[i]);
    return values;
  };
  const double near = kNear * grey.shape.spacing.mean();
  for (const double depth : {near, 0.5 * near})
    if (std::vector<float> values = deeper_than(depth); values.size() >= kEnough) return level_of_values(values);
  std::vector<float> all = deeper_than(0);
  return level_of_values(all);
}

GreyRange range_around(const ScalarGrid& grey, double blur, const std::vector<std::size_t>& seeds) {
  const GreyLevel level = level_around(grey, seeds);
  const double half = kTold * level.deviation;
  GreyRange range{level.median - half, level.median + half};
  for (const std::size_t seed : seeds) {  // a seed of its own darkness is still the organ's
    range.low = std::min<double>(range.low, grey.value[seed]);
    range.high = std::max<double>(range.high, grey.value[seed]);
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<char> inside = in_range(grey, range);
    keep_pieces_with(grey.shape, inside, seeds);
    if (std::ranges::count(inside, 1) > kFull * static_cast<double>(inside.size()))
      throw std::runtime_error(
          fmt::format("grey values of {:.4g} to {:.4g} around the seeds fill the image: they lie in no part that is "
                      "told from the rest; give the organ's --range, or other seeds",
                      range.low, range.high));
    const GreyRange before = range;
    range = range_between(surroundings_of(grey, inside, blur, level.median, range), level.median, range);
    const double change = std::max(std::abs(range.low - before.low), std::abs(range.high - before.high));
    if (change < kSettled * (range.high - range.low)) break;
  }
  return range;
}

std::vector<char> grow_region(const ScalarGrid& grey, const GreyRange& range, const std::vector<std::size_t>& seeds,
                              double neck) {
  for (const std::size_t seed : seeds)
    if (!range.holds(grey.value[seed]))
      throw std::runtime_error(
          fmt::format("{} has the smoothed grey value {:.4g}, which is not within {:.4g} to {:.4g}",
                      say_seed(grey.shape, seed), grey.value[seed], range.low, range.high));
  std::vector<char> inside = in_range(grey, range);
  keep_pieces_with(grey.shape, inside, seeds);
  if (neck <= 0) return inside;
  const DistanceGrid depth = distance_to_border(grey.shape, inside);
  std::vector<char> core(inside.size());
  for (std::size_t i = 0; i < core.size(); ++i) core[i] = depth.value[i] < -0.5 * neck;
  for (const std::size_t seed : seeds)
    if (!core[seed])
      throw std::runtime_error(
          fmt::format("{} lies {:.3g} mm deep in its range, in a part thinner than --neck {:.3g} mm: take one deeper "
                      "inside, or a wider --range",
                      say_seed(grey.shape, seed), -1e3 * depth.value[seed], 1e3 * neck));
  keep_pieces_with(grey.shape, core, seeds);
  const DistanceGrid from_core = distance_to_border(grey.shape, core);
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = inside[i] && from_core.value[i] < 0.5 * neck;
  keep_pieces_with(grey.shape, inside, seeds);
  return inside;
}

}  // namespace palpate
