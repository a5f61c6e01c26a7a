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

Segmentation segment(const ScalarGrid& grey, const std::vector<std::size_t>& seeds, const SegmentationRules& rules) {
  Segmentation s;
  s.range = rules.range ? *rules.range : range_around(grey, seeds);
  s.inside = start_of(grey, seeds, rules, s.range);
  const GreyLevel level = level_of(grey, s.inside);
  for (int k = 0; k < grey.shape.count[2]; ++k)
    s.slices.push_back(segment_slice(grey, k, level, rules, &s.inside[k * layer_of(grey.shape)]));
  agree_with_neighbours(grey.shape, rules.by_hand, s.inside);
  keep_largest_piece(grey.shape, s.inside, "organ", s.findings);
  fill_cavities(grey.shape, s.inside, s.inside, kEveryCavity, "organ", s.findings);
  count_voxels(layer_of(grey.shape), s);
  return s;
}

}  // namespace palpate
