#pragma once
#include <vector>

#include "tools/organ/distance_grid.hpp"

namespace palpate {

/// Grey values that are the organ's, both ends included.
struct GreyRange {
  double low, high;
  bool holds(double grey) const { return grey >= low && grey <= high; }
};

/// Grey values of a region by ranks, which a few odd voxels do not change.
struct GreyLevel {
  double median, deviation;  ///< [grey] the second as a normal distribution's, from the median distance to the median
};
GreyLevel level_of(const ScalarGrid& grey, const std::vector<char>& inside);

/// The range from what lies around the seeds (indices of voxels): what is not told from their neighbourhood by its
/// noise is grown, and the range's ends lie midway to the grey values of what surrounds that, darker and brighter;
/// again with that range, until it stays. `blur` [m]: the deviation by which the values were smoothed. Throws
/// std::runtime_error where the region fills the image.
GreyRange range_around(const ScalarGrid& grey, double blur, const std::vector<std::size_t>& seeds);

/// Voxels of the range that hang together with a seed by their faces. Where `neck` > 0 [m], parts are cut off that hang
/// on by less than this width. Throws std::runtime_error where a seed is out of range, or lies in no thicker part.
std::vector<char> grow_region(const ScalarGrid& grey, const GreyRange& range, const std::vector<std::size_t>& seeds,
                              double neck);

}  // namespace palpate
