#include "tools/organ/segmentation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "tools/organ/voxel_pieces.hpp"

namespace palpate {
namespace {

constexpr double kEveryCavity = std::numeric_limits<double>::infinity();

std::size_t layer_of(const GridShape& shape) {
  return static_cast<std::size_t>(shape.count[0]) * shape.count[1];
}

/// Where the contours start: the region, and what is drawn by hand.
std::vector<char> start_of(const ScalarGrid& grey, const std::vector<std::size_t>& seeds,
                           const SegmentationRules& rules, const GreyRange& range) {
  std::vector<char> inside = grow_region(grey, range, seeds, rules.neck);
  draw_by_hand(rules.by_hand, grey.shape, inside);
  for (const std::size_t seed : seeds)
    if (!inside[seed])
      throw std::runtime_error(
          fmt::format("a seed lies outside of what is drawn by hand in slice {}", seed / layer_of(grey.shape)));
  keep_pieces_with(grey.shape, inside, seeds);
  std::vector<Finding> holes_by_noise;
  fill_cavities(grey.shape, inside, inside, kEveryCavity, "", holes_by_noise);
  return inside;
}

/// The two kinds of smoothed values differ: a seed is in its own range by both.
GreyRange range_for(const SmoothedImage& image, const std::vector<std::size_t>& seeds) {
  GreyRange range = range_around(image.gauss, image.width, seeds);
  for (const std::size_t seed : seeds) {
    range.low = std::min<double>(range.low, image.twiced.value[seed]);
    range.high = std::max<double>(range.high, image.twiced.value[seed]);
  }
  return range;
}

SegmentedSlice segment_slice(const ScalarGrid& grey, int k, const GreyLevel& level, const SegmentationRules& rules,
                             char* inside) {
  SegmentedSlice slice{outlines_of(grey.shape.count[0], grey.shape.count[1], inside), {}, false};
  if (const auto drawn = rules.by_hand.find(k); drawn != rules.by_hand.end()) {
    slice.by_hand = true;
    slice.moved = {{drawn->second, 1}};
    return slice;
  }
  std::vector<Contour> lines;
  for (const Contour& start : slice.start) {
    slice.moved.push_back(move_to_edges(start, grey, k, level, rules.forces));
    lines.push_back(slice.moved.back().line);
  }
  fill_contours(lines, grey.shape.count[0], grey.shape.count[1], inside);
  return slice;
}

/// What no slice beside it has is taken from a slice, and what both have is given to it.
void agree_with_neighbours(const GridShape& shape, const HandContours& by_hand, std::vector<char>& inside) {
  const std::vector<char> before = inside;
  const std::size_t layer = layer_of(shape);
  for (int k = 1; k + 1 < shape.count[2]; ++k) {
    if (by_hand.contains(k)) continue;
    for (std::size_t i = k * layer; i < (k + 1) * layer; ++i)
      if (before[i - layer] == before[i + layer]) inside[i] = before[i - layer];
  }
}

void count_voxels(std::size_t layer, Segmentation& s) {
  auto first = s.inside.begin();
  for (SegmentedSlice& slice : s.slices) {
    const auto end = first + static_cast<std::ptrdiff_t>(layer);
    slice.voxels = static_cast<std::size_t>(std::count(first, end, 1));
    first = end;
  }
}

}  // namespace

double SegmentedSlice::on_edge() const {
  double found = 0, points = 0;
  for (const MovedContour& m : moved) {
    found += m.on_edge * static_cast<double>(m.line.size());
    points += static_cast<double>(m.line.size());
  }
  return points > 0 ? found / points : 0;
}

SmoothedImage smoothed_image(const ScalarGrid& grey, double width) {
  SmoothedImage image{width, grey, grey};
  if (width <= 0) return image;
  smooth(image.gauss, Eigen::Vector3d::Constant(width));
  image.twiced = image.gauss;
  smooth(image.twiced, Eigen::Vector3d::Constant(width));
  for (std::size_t i = 0; i < grey.value.size(); ++i)
    image.twiced.value[i] = 2 * image.gauss.value[i] - image.twiced.value[i];
  return image;
}

Segmentation segment(const SmoothedImage& image, const std::vector<std::size_t>& seeds,
                     const SegmentationRules& rules) {
  Segmentation s;
  s.range = rules.range ? *rules.range : range_for(image, seeds);
  s.inside = start_of(image.twiced, seeds, rules, s.range);
  const GreyLevel level = level_of(image.twiced, s.inside);
  const GridShape& shape = image.twiced.shape;
  for (int k = 0; k < shape.count[2]; ++k)
    s.slices.push_back(segment_slice(image.twiced, k, level, rules, &s.inside[k * layer_of(shape)]));
  agree_with_neighbours(shape, rules.by_hand, s.inside);
  if (std::ranges::count(s.inside, 1) == 0)
    throw std::runtime_error("nothing is left of the region in its slices: it is a voxel or two; give a wider --range");
  keep_largest_piece(shape, s.inside, "organ", s.findings);
  fill_cavities(shape, s.inside, s.inside, kEveryCavity, "organ", s.findings);
  count_voxels(layer_of(shape), s);
  return s;
}

}  // namespace palpate
