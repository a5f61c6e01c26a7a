#include "common/geometry/buckets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr double kMaxCells = 1 << 24;
constexpr double kRounding = 1e-9;  // of a query's reach: nothing on its border is lost to rounding

}  // namespace

Buckets::Buckets(std::span<const Vector3d> positions, std::span<const std::array<int, 3>> triangles, double size)
    : range_(triangles.size()), first_of_triangle_(triangles.size(), -1), stamp_(triangles.size(), 0) {
  lay_grid(positions, size);
  // Four times what the rest position takes, and eight entries a triangle; one more each for the overflow.
  std::size_t needed = 0;
  std::vector<std::array<Vector3d, 2>> boxes;
  for (const auto& t : triangles) {
    const Vector3d &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
    boxes.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)});
    needed += std::min(range_of(boxes.back()[0], boxes.back()[1]).count(), kMaxBuckets);
  }
  take_entries(4 * needed + 9 * triangles.size());
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) move(t, boxes[t][0], boxes[t][1]);
}

Buckets::Buckets(std::span<const Vector3d> positions, double size, int most, std::size_t entries)
    : range_(most), first_of_triangle_(most, -1), stamp_(most, 0) {
  lay_grid(positions, size);
  take_entries(entries + most);
}

void Buckets::lay_grid(std::span<const Vector3d> positions, double size) {
  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();
  if (!positions.empty()) low = high = positions[0];
  for (const Vector3d& p : positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double margin = 0.5 * (high - low).norm();
  origin_ = low.array() - margin;
  const Vector3d counts = ((high - low).array() + 2 * margin) / size;
  if (!(size > 0) || !(counts.array().ceil().cwiseMax(1).prod() <= kMaxCells))
    throw std::runtime_error(
        fmt::format("a bucket size of {} m does not suit a surface {:.4g} m across", size, (high - low).norm()));
  size_ = size;
  per_metre_ = 1 / size;
  for (int axis = 0; axis < 3; ++axis) cells_[axis] = std::max(1, static_cast<int>(std::ceil(counts[axis])));
  filled_.low = cells_;
  first_overflow_ = cells_[0] * cells_[1] * cells_[2];
  first_in_bucket_.assign(first_overflow_ + 1, -1);
}

void Buckets::take_entries(std::size_t count) {
  entries_.resize(count);
  for (int i = static_cast<int>(count) - 1; i >= 0; --i) entries_[i].after = free_, free_ = i;
  free_count_ = static_cast<int>(count);
}

std::size_t Buckets::bytes() const {
  return sizeof(int) * (first_in_bucket_.capacity() + first_of_triangle_.capacity()) +
         sizeof(Range) * range_.capacity() + sizeof(Entry) * entries_.capacity() +
         sizeof(std::uint32_t) * stamp_.capacity();
}

Buckets::Range Buckets::range_of(const Vector3d& box_min, const Vector3d& box_max) const {
  Range range;
  for (int axis = 0; axis < 3; ++axis) {
    // Not a number becomes an end of the grid: nothing is lost.
    const double last = cells_[axis] - 1;
    const double low = std::floor((box_min[axis] - origin_[axis]) * per_metre_);
    const double high = std::floor((box_max[axis] - origin_[axis]) * per_metre_);
    range.low[axis] = low > 0 ? static_cast<int>(std::min(low, last)) : 0;
    range.high[axis] = high < last ? static_cast<int>(std::max(high, 0.0)) : static_cast<int>(last);
  }
  return range;
}

// Distance along one axis between an interval and a layer of buckets; the outermost layers reach to infinity.
double Buckets::apart(double low, double high, int index, int axis) const {
  const double begin = origin_[axis] + index * size_;
  const double before = index > 0 ? begin - high : 0;
  const double behind = index < cells_[axis] - 1 ? low - (begin + size_) : 0;
  return std::max(0.0, std::max(before, behind));
}

template <class Visit>
void Buckets::for_each_bucket(const Range& range, Visit&& visit) const {
  for (int k = range.low[2]; k <= range.high[2]; ++k)
    for (int j = range.low[1]; j <= range.high[1]; ++j)
      for (int i = range.low[0]; i <= range.high[0]; ++i) visit((k * cells_[1] + j) * cells_[0] + i);
}

void Buckets::move(int triangle, const Vector3d& box_min, const Vector3d& box_max) {
  const Range range = range_of(box_min, box_max);
  if (range == range_[triangle]) return;
  leave(triangle);
  range_[triangle] = range;
  enter(triangle);
}

void Buckets::remove(int triangle) {
  leave(triangle);
  range_[triangle] = {};
}

void Buckets::link(int triangle, int bucket) {
  const int entry = free_;
  free_ = entries_[entry].after;
  --free_count_;
  const int first = first_in_bucket_[bucket];
  entries_[entry] = {triangle, bucket, -1, first, first_of_triangle_[triangle]};
  if (first >= 0) entries_[first].before = entry;
  first_in_bucket_[bucket] = entry;
  first_of_triangle_[triangle] = entry;
  overflow_count_ += bucket == first_overflow_;
}

void Buckets::enter(int triangle) {
  const Range& range = range_[triangle];
  const int count = range.count();
  // Each triangle keeps one entry in reserve, so that the overflow itself always has room.
  const int reserve = static_cast<int>(range_.size());
  if (count > kMaxBuckets || free_count_ - count < reserve) return link(triangle, first_overflow_);
  for_each_bucket(range, [&](int bucket) { link(triangle, bucket); });
  for (int axis = 0; axis < 3; ++axis) {
    filled_.low[axis] = std::min(filled_.low[axis], range.low[axis]);
    filled_.high[axis] = std::max(filled_.high[axis], range.high[axis]);
  }
}

void Buckets::leave(int triangle) {
  for (int entry = first_of_triangle_[triangle]; entry >= 0;) {
    const Entry gone = entries_[entry];
    if (gone.before >= 0) entries_[gone.before].after = gone.after;
    if (gone.before < 0) first_in_bucket_[gone.bucket] = gone.after;
    if (gone.after >= 0) entries_[gone.after].before = gone.before;
    overflow_count_ -= gone.bucket == first_overflow_;
    entries_[entry].after = free_;
    free_ = entry;
    ++free_count_;
    entry = gone.next_of_triangle;
  }
  first_of_triangle_[triangle] = -1;
}

Buckets::Range Buckets::range_to_look_at(const Vector3d& box_min, const Vector3d& box_max) const {
  Range range = range_of(box_min, box_max);
  for (int axis = 0; axis < 3; ++axis) {
    range.low[axis] = std::max(range.low[axis], filled_.low[axis]);
    range.high[axis] = std::min(range.high[axis], filled_.high[axis]);
  }
  return range;
}

void Buckets::begin_query() const {
  if (++clock_ != 0) return;
  std::fill(stamp_.begin(), stamp_.end(), 0u);
  clock_ = 1;
}

// Adds what the query has not found yet; returns how many there are then.
int Buckets::collect(int bucket, std::span<int> found, int count) const {
  for (int entry = first_in_bucket_[bucket]; entry >= 0; entry = entries_[entry].after) {
    const int triangle = entries_[entry].triangle;
    if (stamp_[triangle] == clock_) continue;
    stamp_[triangle] = clock_;
    found[count++] = triangle;
  }
  return count;
}

int Buckets::query(const Vector3d& box_min, const Vector3d& box_max, double radius, std::span<int> found) const {
  assert(found.size() >= range_.size());
  begin_query();
  int count = 0;
  const double reach = radius + kRounding * (radius + size_);
  const Range range = range_to_look_at(box_min.array() - reach, box_max.array() + reach);
  for (int k = range.low[2]; k <= range.high[2]; ++k)
    for (int j = range.low[1]; j <= range.high[1]; ++j) {
      const double z = apart(box_min.z(), box_max.z(), k, 2), y = apart(box_min.y(), box_max.y(), j, 1);
      const double left = reach * reach - z * z - y * y;
      if (left < 0) continue;
      for (int i = range.low[0]; i <= range.high[0]; ++i) {
        const double x = apart(box_min.x(), box_max.x(), i, 0);
        if (!(x * x > left)) count = collect((k * cells_[1] + j) * cells_[0] + i, found, count);
      }
    }
  return collect(first_overflow_, found, count);
}

// The part of a piece of a segment that lies within `reach` [m] of a layer of buckets.
Buckets::Piece Buckets::along_layer(const Segment& s, const Piece& piece, double reach, int index, int axis) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double begin = origin_[axis] + index * size_ - reach, way = s.end[axis] - s.start[axis];
  const double low = index > 0 ? begin - s.start[axis] : -kInfinity;
  const double high = index < cells_[axis] - 1 ? begin + size_ + 2 * reach - s.start[axis] : kInfinity;
  if (way == 0) return low <= 0 && high >= 0 ? piece : Piece{1, 0};
  const auto [from, to] = std::minmax({low / way, high / way});
  return {std::max(piece.from, from), std::min(piece.to, to)};
}

int Buckets::query(const Segment& segment, double radius, std::span<int> found) const {
  assert(found.size() >= range_.size());
  begin_query();
  int count = 0;
  const double reach = radius + kRounding * (radius + size_);
  const auto around = [&](const Piece& piece) {
    const Vector3d a = segment.at(piece.from), b = segment.at(piece.to);
    return range_to_look_at(a.cwiseMin(b).array() - reach, a.cwiseMax(b).array() + reach);
  };
  const Range layers = around({0, 1});
  for (int k = layers.low[2]; k <= layers.high[2]; ++k) {
    const Piece in_layer = along_layer(segment, {0, 1}, reach, k, 2);
    if (in_layer.from > in_layer.to) continue;
    const Range rows = around(in_layer);
    for (int j = rows.low[1]; j <= rows.high[1]; ++j) {
      const Piece in_row = along_layer(segment, in_layer, reach, j, 1);
      if (in_row.from > in_row.to) continue;
      const Range row = around(in_row);
      for (int i = row.low[0]; i <= row.high[0]; ++i)
        count = collect((k * cells_[1] + j) * cells_[0] + i, found, count);
    }
  }
  return collect(first_overflow_, found, count);
}

}  // namespace palpate
