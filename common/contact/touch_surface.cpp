#include "common/contact/touch_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace palpate {

TouchSurface::TouchSurface(const SurfaceMap& map, double bucket_size)
    : ContactSurface(map.position, map.triangles),
      first_of_node_(map.size() + 1, 0),
      movable_(map.touchable),
      buckets_(map.position, map.triangles, bucket_size),
      slack_(0.05 * bucket_size),
      piece_(2 * bucket_size),
      low_(Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())),
      high_(-low_),
      entered_(map.triangles.size()) {
  for (const auto& t : triangles_)
    for (int node : t) ++first_of_node_[node + 1];
  for (int n = 0; n < map.size(); ++n) first_of_node_[n + 1] += first_of_node_[n];
  of_node_.resize(3 * triangles_.size());
  std::vector<int> next(first_of_node_.begin(), first_of_node_.end() - 1);
  for (int t = 0; t < triangle_count(); ++t)
    for (int node : triangles_[t]) of_node_[next[node]++] = t;
  for (int t = 0; t < triangle_count(); ++t) {
    const Triangle c = corners(t);
    entered_[t] = {c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])};
  }
  for (const Eigen::Vector3d& x : position_) low_ = low_.cwiseMin(x), high_ = high_.cwiseMax(x);
  for (int n = 0; n < map.size(); ++n) rest_normal_.push_back(vertex_normal(n));
  for (int n = movable_; n < map.size(); ++n) touchable_[n] = 0;
  found_.resize(triangles_.size());
  found_along_.reserve(triangles_.size());
  found_stamp_.assign(triangles_.size(), 0);
  marked_.reserve(map.size());
  last_marked_.reserve(map.size());
  stamp_.assign(map.size(), 0);
  triangle_stamp_.assign(triangles_.size(), 0);
}

Eigen::Vector3d TouchSurface::vertex_normal(int node) const {
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  for (int i = first_of_node_[node]; i < first_of_node_[node + 1]; ++i) n += triangle_normal(of_node_[i]);
  return n.normalized();
}

Eigen::Vector3d TouchSurface::outer_side(const std::array<int, 3>& nodes) const {
  return (rest_[nodes[1]] - rest_[nodes[0]]).cross(rest_[nodes[2]] - rest_[nodes[0]]).normalized();
}

// Triangles whose swept boxes come within `radius` of a box, into found_, in no order; returns how many.
int TouchSurface::collect(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double radius) const {
  if (((low_ - high).cwiseMax(low - high_).array() > radius).any()) return 0;  // far from all of it
  const int candidates = buckets_.query(low, high, radius, found_);
  // The buckets' answer depends on when entries were last moved; the boxes themselves do not, and replay needs that.
  const auto is_near = [&](const std::array<Eigen::Vector3d, 2>& box) {
    const Eigen::Vector3d apart = (box[0] - high).cwiseMax(low - box[1]).cwiseMax(0.0);
    return apart.squaredNorm() <= radius * radius;
  };
  int kept = 0;
  for (int i = 0; i < candidates; ++i) {
    const int t = found_[i];
    if (is_near(entered_[t]) && is_near(swept_box(t))) found_[kept++] = t;  // the first holds the second
  }
  return kept;
}

std::span<const int> TouchSurface::find(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) const {
  const int kept = collect(a.cwiseMin(b), a.cwiseMax(b), radius);
  std::sort(found_.begin(), found_.begin() + kept);
  return std::span(found_).first(kept);
}

std::span<const int> TouchSurface::find(const Segment& before, const Segment& now, double radius) const {
  if (now.start == now.end && before.start == before.end) return find(before.start, now.start, radius);
  found_along_.clear();
  ++found_clock_;
  const double motion =
      std::sqrt(std::max((now.start - before.start).squaredNorm(), (now.end - before.end).squaredNorm()));
  const int pieces = 1 + static_cast<int>(now.length() / piece_);
  for (int i = 0; i < pieces; ++i) {
    const double a = static_cast<double>(i) / pieces, b = static_cast<double>(i + 1) / pieces;
    const Eigen::Vector3d ends[] = {before.at(a), before.at(b), now.at(a), now.at(b)};
    const int count = collect(ends[0].cwiseMin(ends[1]).cwiseMin(ends[2]).cwiseMin(ends[3]),
                              ends[0].cwiseMax(ends[1]).cwiseMax(ends[2]).cwiseMax(ends[3]), radius);
    for (int k = 0; k < count; ++k) {
      if (found_stamp_[found_[k]] == found_clock_) continue;
      found_stamp_[found_[k]] = found_clock_;
      const auto [low, high] = swept_box(found_[k]);
      const Eigen::Vector3d middle = 0.5 * (low + high);
      const double farthest = radius + motion + 0.5 * (high - low).norm();
      if ((nearest_point(now, middle) - middle).squaredNorm() <= farthest * farthest) found_along_.push_back(found_[k]);
    }
  }
  std::sort(found_along_.begin(), found_along_.end());
  return found_along_;
}

void TouchSurface::begin_update() {
  ++clock_;
  last_marked_.swap(marked_);
  marked_.clear();
  for (int i = 0; i < kRefreshedInTurn && i < movable_; ++i) {
    mark_node(turn_);
    turn_ = (turn_ + 1) % movable_;
  }
}

void TouchSurface::mark_node(int node) {
  if (node >= movable_ || stamp_[node] == clock_) return;
  stamp_[node] = clock_;
  marked_.push_back(node);
}

void TouchSurface::mark_triangles(std::span<const int> triangles) {
  for (int t : triangles)
    for (int node : triangles_[t]) mark_node(node);
}

void TouchSurface::mark_all() {
  for (int node = 0; node < movable_; ++node) mark_node(node);
}

void TouchSurface::enter(int triangle) {
  if (triangle_stamp_[triangle] == triangle_clock_) return;
  triangle_stamp_[triangle] = triangle_clock_;
  const Triangle a = corners(triangle), b = previous_corners(triangle);
  const Eigen::Vector3d low = a[0].cwiseMin(a[1]).cwiseMin(a[2]).cwiseMin(b[0]).cwiseMin(b[1]).cwiseMin(b[2]);
  const Eigen::Vector3d high = a[0].cwiseMax(a[1]).cwiseMax(a[2]).cwiseMax(b[0]).cwiseMax(b[1]).cwiseMax(b[2]);
  // Small motions stay within the box that was entered; one that has become far too large is entered anew.
  auto& [entered_low, entered_high] = entered_[triangle];
  const bool inside = (low.array() >= entered_low.array()).all() && (high.array() <= entered_high.array()).all();
  const bool snug = ((entered_high - entered_low) - (high - low)).maxCoeff() <= 4 * slack_;
  if (inside && snug) return;
  entered_low = low.array() - slack_;
  entered_high = high.array() + slack_;
  buckets_.move(triangle, entered_low, entered_high);
}

void TouchSurface::move_marked(std::span<const double> displacement) {
  for (int node : last_marked_)
    if (stamp_[node] != clock_) previous_[node] = position_[node];
  for (std::size_t i = 0; i < marked_.size(); ++i) {
    const int node = marked_[i];
    previous_[node] = position_[node];
    position_[node] = rest_[node] + Eigen::Map<const Eigen::Vector3d>(displacement.data() + 3 * i);
    low_ = low_.cwiseMin(position_[node]);
    high_ = high_.cwiseMax(position_[node]);
  }
  ++triangle_clock_;
  for (int node : marked_) {
    if (position_[node] == previous_[node]) continue;
    for (int i = first_of_node_[node]; i < first_of_node_[node + 1]; ++i) enter(of_node_[i]);
  }
}

bool TouchSurface::encloses(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d along = Eigen::Vector3d(0.5377, 0.3189, 0.7804).normalized();  // meets no edge of a tidy mesh
  int crossings = 0;
  for (int t = 0; t < triangle_count(); ++t) {
    const Triangle c = corners(t);
    const Eigen::Vector3d e1 = c[1] - c[0], e2 = c[2] - c[0], h = along.cross(e2);
    const double det = e1.dot(h);
    if (det == 0) continue;
    const Eigen::Vector3d s = p - c[0];
    const double u = s.dot(h) / det;
    const Eigen::Vector3d q = s.cross(e1);
    const double v = along.dot(q) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && e2.dot(q) / det > 0) ++crossings;
  }
  return crossings % 2 == 1;
}

void TouchSurface::state(State& s) {
  s.bytes(previous_.data(), 3 * sizeof(double) * previous_.size());
  s.bytes(position_.data(), 3 * sizeof(double) * position_.size());
  s.value(turn_);
  if (s.restoring()) follow_restored();
}

void TouchSurface::follow_restored() {
  turn_ = movable_ > 0 ? static_cast<int>(static_cast<unsigned>(turn_) % static_cast<unsigned>(movable_)) : 0;
  // All nodes count as moved in the step before, so that previous positions settle as they did when this was saved.
  marked_.clear();
  for (int n = 0; n < movable_; ++n) marked_.push_back(n);
  for (int n = 0; n < static_cast<int>(position_.size()); ++n) {
    low_ = low_.cwiseMin(position_[n]).cwiseMin(previous_[n]);
    high_ = high_.cwiseMax(position_[n]).cwiseMax(previous_[n]);
  }
  ++triangle_clock_;
  for (int t = 0; t < triangle_count(); ++t) enter(t);
}

}  // namespace palpate
