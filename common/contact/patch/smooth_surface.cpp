#include "common/contact/patch/smooth_surface.hpp"

#include <algorithm>
#include <cmath>

#include "common/contact/tool_contacts.hpp"

namespace palpate {

using Eigen::Vector3d;

std::vector<double> longest_edges(const SurfaceMap& map) {
  std::vector<double> longest(map.size(), 0.0);
  for (const auto& t : map.triangles)
    for (int v = 0; v < 3; ++v) {
      const int a = t[v], b = t[(v + 1) % 3];
      const double edge = (map.position[a] - map.position[b]).norm();
      longest[a] = std::max(longest[a], edge);
      longest[b] = std::max(longest[b], edge);
    }
  return longest;
}

SmoothSurface::SmoothSurface(const SurfaceMap& map)
    : map_(map),
      node_normal_(map.size(), Vector3d::Zero()),
      weight_(map.size(), 0.0),
      left_out_(map.triangles.size(), 0),
      buckets_(map.position, map.triangles, 2 * mean_edge(map)),
      found_(map.triangles.size()) {
  for (std::size_t t = 0; t < map.triangles.size(); ++t) {
    const Triangle c = corners(static_cast<int>(t));
    const Vector3d doubled_area = (c[1] - c[0]).cross(c[2] - c[0]);
    facet_.push_back({doubled_area.normalized(), (c[0] + c[1] + c[2]) / 3, 0, 0});
    area_.push_back(0.5 * doubled_area.norm());
    box_.push_back({c[0].cwiseMin(c[1]).cwiseMin(c[2]), c[0].cwiseMax(c[1]).cwiseMax(c[2])});
    Facet& f = facet_.back();
    for (const Vector3d& corner : c) f.reach = std::max(f.reach, (corner - f.middle).norm());
    for (int v = 0; v < 3; ++v) {
      const Vector3d a = (c[(v + 1) % 3] - c[v]).normalized(), b = (c[(v + 2) % 3] - c[v]).normalized();
      weight_[map.triangles[t][v]] += area_.back() / 3;
      node_normal_[map.triangles[t][v]] += std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * f.normal;
    }
  }
  for (Vector3d& n : node_normal_) n.normalize();
  find_across();
}

void SmoothSurface::find_across() {
  struct Side {
    std::array<int, 2> nodes;  // ascending
    int triangle, corner;
  };
  std::vector<Side> sides;
  across_.assign(map_.triangles.size(), {kNone, kNone, kNone});
  for (int t = 0; t < static_cast<int>(map_.triangles.size()); ++t)
    for (int v = 0; v < 3; ++v) {
      const auto [low, high] = std::minmax(map_.triangles[t][v], map_.triangles[t][(v + 1) % 3]);
      sides.push_back({{low, high}, t, v});
    }
  std::ranges::stable_sort(sides, {}, &Side::nodes);
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].nodes == sides[i].nodes) ++end;
    if (end - i != 2) continue;
    across_[sides[i].triangle][sides[i].corner] = sides[i + 1].triangle;
    across_[sides[i + 1].triangle][sides[i + 1].corner] = sides[i].triangle;
  }
  for (std::size_t t = 0; t < across_.size(); ++t)
    for (const int beyond : across_[t])
      facet_[t].bend =
          std::max(facet_[t].bend, beyond == kNone ? kEnds : (facet_[t].normal - facet_[beyond].normal).norm());
}

void SmoothSurface::leave_out(int t) {
  left_out_[t] = 1;
  for (const int beyond : across_[t])
    if (beyond != kNone) facet_[beyond].bend = kEnds;
}

Vector3d SmoothSurface::normal(int t, const Vector3d& weights) const {
  const auto& n = map_.triangles[t];
  return (weights[0] * node_normal_[n[0]] + weights[1] * node_normal_[n[1]] + weights[2] * node_normal_[n[2]])
      .normalized();
}

std::span<int> SmoothSurface::near(const Vector3d& point, double radius) const {
  const int candidates = buckets_.query(point, point, radius, found_);
  int kept = 0;
  for (int i = 0; i < candidates; ++i) {
    if (left_out_[found_[i]]) continue;
    const auto& [low, high] = box_[found_[i]];
    const Vector3d apart = (low - point).cwiseMax(point - high).cwiseMax(0.0);
    if (apart.squaredNorm() <= radius * radius) found_[kept++] = found_[i];
  }
  std::sort(found_.begin(), found_.begin() + kept);
  return std::span(found_).first(kept);
}

std::span<int> SmoothSurface::near(const Segment& segment, double radius) const {
  const int candidates = buckets_.query(segment, radius, found_);
  int kept = 0;
  for (int i = 0; i < candidates; ++i) {
    if (left_out_[found_[i]]) continue;
    const Vector3d& middle = facet_[found_[i]].middle;
    const double reach = radius + facet_[found_[i]].reach;
    if ((nearest_point(segment, middle) - middle).squaredNorm() <= reach * reach) found_[kept++] = found_[i];
  }
  std::sort(found_.begin(), found_.begin() + kept);
  return std::span(found_).first(kept);
}

}  // namespace palpate
