#include "tools/organ/polygons.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace palpate {
namespace {

/// Corners of a polygon in its own plane, seen so that it goes round to the left.
std::vector<Eigen::Vector2d> flattened(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& polygon) {
  const Eigen::Vector3d& from = points[polygon[0]];
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t c = 2; c < polygon.size(); ++c)
    normal += (points[polygon[c - 1]] - from).cross(points[polygon[c]] - from);
  normal.normalize();
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Eigen::Vector2d> flat;
  for (const int n : polygon) flat.emplace_back(u.dot(points[n] - from), v.dot(points[n] - from));
  return flat;
}

/// Twice the area, positive to the left.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

/// Cuts ears off: corners whose triangle holds no other corner.
class Ears {
 public:
  explicit Ears(std::vector<Eigen::Vector2d> places) : places_(std::move(places)) {
    for (int c = 0; c < static_cast<int>(places_.size()); ++c) left_.push_back(c);
  }

  std::vector<std::array<int, 3>> cut() {
    std::vector<std::array<int, 3>> ears;
    std::size_t at = 0;
    while (left_.size() > 3) {
      at = next_ear(at);
      ears.push_back({before(at), left_[at], after(at)});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
    }
    ears.push_back({left_[0], left_[1], left_[2]});
    return ears;
  }

  bool is_convex() const {
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (bend(i) < 0) return false;
    return true;
  }

 private:
  int before(std::size_t i) const { return left_[(i + left_.size() - 1) % left_.size()]; }
  int after(std::size_t i) const { return left_[(i + 1) % left_.size()]; }
  double bend(std::size_t i) const { return turn(places_[before(i)], places_[left_[i]], places_[after(i)]); }

  /// From `from` on; where there is none, since the polygon crosses itself or has no area, some corner.
  std::size_t next_ear(std::size_t from) const {
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (const std::size_t at = (from + i) % left_.size(); is_ear(at)) return at;
    return from % left_.size();
  }

  bool is_ear(std::size_t i) const {
    if (bend(i) <= 0) return false;
    const Eigen::Vector2d &a = places_[before(i)], &b = places_[left_[i]], &c = places_[after(i)];
    return std::ranges::none_of(left_, [&](int corner) {
      const Eigen::Vector2d& x = places_[corner];
      if (x == a || x == b || x == c) return false;
      return turn(a, b, x) >= 0 && turn(b, c, x) >= 0 && turn(c, a, x) >= 0;
    });
  }

  std::vector<Eigen::Vector2d> places_;
  std::vector<int> left_;
};

}  // namespace

std::vector<std::array<int, 3>> cut_polygon(const std::vector<Eigen::Vector3d>& points,
                                            const std::vector<int>& polygon) {
  std::vector<std::array<int, 3>> triangles;
  Ears ears(polygon.size() > 3 ? flattened(points, polygon) : std::vector<Eigen::Vector2d>());
  if (!ears.is_convex()) {
    for (const auto& [a, b, c] : ears.cut()) triangles.push_back({polygon[a], polygon[b], polygon[c]});
    return triangles;
  }
  for (std::size_t c = 2; c < polygon.size(); ++c) triangles.push_back({polygon[0], polygon[c - 1], polygon[c]});
  return triangles;
}

}  // namespace palpate
