#include "common/models/catheter/lumen.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

namespace palpate {
namespace {

using Eigen::Vector3d;

/// Solid angle of a triangle seen from p, positive where p is behind its normal (van Oosterom and Strackee
/// 1983).
double solid_angle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d u = a - p, v = b - p, w = c - p;
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  return 2 * std::atan2(u.dot(v.cross(w)), lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv);
}

}  // namespace

Lumen::Lumen(const DuctWall* wall, std::span<const Vector3d> x, double radius) : wall_(wall) {
  if (!wall_) return;
  if (wall_->mouths().empty()) throw std::runtime_error("the duct that the catheter is led into has no open end");
  edge_mouth_.assign(wall_->surface().triangle_count(), {-1, -1, -1});
  node_mouth_.assign(wall_->surface().positions().size(), -1);
  for (const auto& loop : wall_->mouths()) {
    mouths_.push_back({.nodes = loop, .first = static_cast<int>(seen_.size())});
    for (const int node : loop) seen_.push_back(wall_->surface().positions()[node]);
    orient(mouths_.back());
  }
  last_ = seen_;
  refresh();
  for (const Mouth& mouth : mouths_) {
    check_width(mouth, radius);
    reach_ = std::max(reach_, 2 * mouth.cap.radius);
  }
  for (const Vector3d& p : x) inside_.push_back(winding(p) > 0.5);
}

/// Turns the loop so that its caps look out, and notes the triangles' edges that lie on it.
void Lumen::orient(Mouth& mouth) {
  const TouchSurface& surface = wall_->surface();
  std::map<std::pair<int, int>, int> edges;
  const int count = static_cast<int>(mouth.nodes.size()), index = static_cast<int>(mouths_.size()) - 1;
  for (const int node : mouth.nodes) node_mouth_[node] = index;
  for (int i = 0; i < count; ++i) edges[{mouth.nodes[i], mouth.nodes[(i + 1) % count]}] = i;
  int along = 0, against = 0;
  for (int t = 0; t < surface.triangle_count(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const int a = surface.triangle(t)[(corner + 1) % 3], b = surface.triangle(t)[(corner + 2) % 3];
      const bool forward = edges.count({a, b}) > 0, backward = edges.count({b, a}) > 0;
      if (!forward && !backward) continue;
      ++(forward ? along : against);
      edge_mouth_[t][corner] = index;
    }
  }
  if (along + against != count || (along > 0 && against > 0))
    throw std::runtime_error("an open end of the duct is not a simple loop of its triangles' edges");
  if (along == 0) return;
  std::reverse(mouth.nodes.begin(), mouth.nodes.end());
  std::reverse(seen_.begin() + mouth.first, seen_.end());
}

Lumen::Cap Lumen::measure(const Mouth& mouth, std::span<const Vector3d> nodes) const {
  Cap cap;
  const int count = static_cast<int>(mouth.nodes.size());
  const auto node = [&](int i) -> const Vector3d& { return nodes[mouth.first + i % count]; };
  for (int i = 0; i < count; ++i) cap.middle += node(i) / count;
  for (int i = 0; i < count; ++i) cap.normal += (node(i) - cap.middle).cross(node(i + 1) - cap.middle);
  cap.normal.normalize();
  for (int i = 0; i < count; ++i) {
    cap.radius = std::max(cap.radius, (node(i) - cap.middle).norm());
    cap.depth = std::max(cap.depth, std::abs((node(i) - cap.middle).dot(cap.normal)));
  }
  return cap;
}

void Lumen::check_width(const Mouth& mouth, double radius) const {
  double narrowest = mouth.cap.radius;
  const int count = static_cast<int>(mouth.nodes.size());
  for (int i = 0; i < count; ++i) {
    const Vector3d &a = seen_[mouth.first + i], &b = seen_[mouth.first + (i + 1) % count];
    narrowest = std::min(narrowest, (mouth.cap.middle - a).cross(b - a).norm() / (b - a).norm());
  }
  if (radius + wall_->half_thickness() < narrowest) return;
  throw std::runtime_error("the catheter is wider than the duct that it is led into");
}

double Lumen::winding(const Vector3d& p) const {
  const TouchSurface& surface = wall_->surface();
  double angle = 0;
  for (int t = 0; t < surface.triangle_count(); ++t) {
    const Triangle c = surface.corners(t);
    angle += solid_angle(p, c[0], c[1], c[2]);
  }
  for (const Mouth& mouth : mouths_) {
    const int count = static_cast<int>(mouth.nodes.size());
    for (int i = 0; i < count; ++i)
      angle += solid_angle(p, mouth.cap.middle, seen_[mouth.first + i], seen_[mouth.first + (i + 1) % count]);
  }
  return angle / (4 * std::numbers::pi);
}

void Lumen::release_lost(std::span<const Vector3d> x) {
  if (inside_.empty()) return;
  turn_ = (turn_ + 1) % static_cast<int>(inside_.size());
  if (inside_[turn_] && wall_->surface().find(x[turn_], x[turn_], reach_).empty()) leave(turn_);
}

void Lumen::follow_chain(std::span<const Vector3d> x) {
  for (std::size_t i = 0; i + 1 < inside_.size(); ++i) {
    const auto hit = crossing(x[i], x[i + 1]);
    const bool belongs = hit ? hit->from_outside : inside_[i] != 0;
    if (belongs != (inside_[i + 1] != 0) && !cuts_wall(x[i], x[i + 1], hit ? hit->time : 0)) inside_[i + 1] = belongs;
  }
}

bool Lumen::cuts_wall(const Vector3d& from, const Vector3d& to, double after) const {
  const TouchSurface& surface = wall_->surface();
  return std::ranges::any_of(surface.find(from, to, 0), [&](int t) {
    const auto hit = sweep_point(from, to, surface.corners(t), surface.corners(t));
    return hit && hit->time >= after;
  });
}

void Lumen::refresh() {
  turn_ = std::clamp(turn_, 0, std::max(0, static_cast<int>(inside_.size()) - 1));
  for (Mouth& mouth : mouths_) mouth.cap = measure(mouth, seen_);
}

void Lumen::follow_mouths(std::span<const Vector3d> x) {
  last_.swap(seen_);
  for (Mouth& mouth : mouths_) {
    bool moved = false;
    for (std::size_t i = 0; i < mouth.nodes.size(); ++i) {
      const Vector3d& node = wall_->surface().positions()[mouth.nodes[i]];
      moved |= node != last_[mouth.first + i];
      seen_[mouth.first + i] = node;
    }
    if (!moved) continue;
    const Cap was = mouth.cap;
    mouth.cap = measure(mouth, seen_);
    for (std::size_t i = 0; i < x.size(); ++i) cross(i, x[i], x[i], mouth, was, last_);
  }
}

void Lumen::follow_particles(std::span<const Vector3d> before, std::span<const Vector3d> now) {
  for (const Mouth& mouth : mouths_)
    for (std::size_t i = 0; i < now.size(); ++i) cross(i, before[i], now[i], mouth, mouth.cap, seen_);
}

std::optional<SweptHit> Lumen::crossing(const Vector3d& from, const Vector3d& to, const Mouth& mouth, const Cap& was,
                                        std::span<const Vector3d> last_nodes) const {
  std::optional<SweptHit> last;
  const Cap& is = mouth.cap;
  const Vector3d start = from - was.middle, end = to - is.middle;
  const double wide = 1.01 * std::max(was.radius, is.radius) + (to - from).norm() + (is.middle - was.middle).norm();
  if (start.squaredNorm() > wide * wide && end.squaredNorm() > wide * wide) return last;
  const double uneven = std::max(was.depth, is.depth) + (is.normal - was.normal).norm() * wide + 1e-6 * is.radius;
  const double ahead = start.dot(was.normal), then = end.dot(is.normal);
  if (std::min(ahead, then) > uneven || std::max(ahead, then) < -uneven) return last;
  const int count = static_cast<int>(mouth.nodes.size());
  for (int i = 0; i < count; ++i) {
    const int a = mouth.first + i, b = mouth.first + (i + 1) % count;
    const auto hit = sweep_point(from, to, {was.middle, last_nodes[a], last_nodes[b]}, {is.middle, seen_[a], seen_[b]});
    if (hit && (!last || hit->time >= last->time)) last = hit;
  }
  return last;
}

void Lumen::cross(int particle, const Vector3d& from, const Vector3d& to, const Mouth& mouth, const Cap& was,
                  std::span<const Vector3d> last_nodes) {
  if (const auto hit = crossing(from, to, mouth, was, last_nodes)) inside_[particle] = hit->from_outside;
}

std::optional<SweptHit> Lumen::crossing(const Vector3d& from, const Vector3d& to) const {
  for (const Mouth& mouth : mouths_)
    if (auto hit = crossing(from, to, mouth, mouth.cap, seen_)) return hit;
  return std::nullopt;
}

int Lumen::rim_at(int triangle, const Vector3d& weights) const {
  for (int corner = 0; corner < 3; ++corner) {
    if (weights[corner] == 0 && edge_mouth_[triangle][corner] >= 0) return edge_mouth_[triangle][corner];
    if (weights[corner] == 1) return node_mouth_[wall_->surface().triangle(triangle)[corner]];
  }
  return -1;
}

bool Lumen::past_rim(int mouth, const Vector3d& p, const Vector3d& q) const {
  const Cap& cap = mouths_[mouth].cap;
  const Vector3d from_middle = q - cap.middle, beside = from_middle - cap.normal * cap.normal.dot(from_middle);
  return (p - q).dot(cap.normal) > 0 && (p - q).dot(beside) > 0;
}

bool Lumen::before_mouth(const Vector3d& p) const {
  for (const Mouth& mouth : mouths_) {
    const Vector3d away = p - mouth.cap.middle;
    const double near = 1.5 * mouth.cap.radius, ahead = away.dot(mouth.cap.normal);
    if (away.squaredNorm() < near * near && ahead > -mouth.cap.depth - 1e-6 * mouth.cap.radius) return true;
  }
  return false;
}

double Lumen::inserted(std::span<const Vector3d> x, double spacing) const {
  if (inside_.empty()) return 0;
  double length = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    if (inside_[i] && inside_[i + 1]) length += spacing;
    if (inside_[i] == inside_[i + 1]) continue;
    const Vector3d &in = inside_[i] ? x[i] : x[i + 1], &out = inside_[i] ? x[i + 1] : x[i];
    double share = 0.5, nearest = -1;
    for (const Mouth& mouth : mouths_) {
      const double away = (0.5 * (in + out) - mouth.cap.middle).squaredNorm();
      const double depth = (mouth.cap.middle - in).dot(mouth.cap.normal),
                   ahead = (out - mouth.cap.middle).dot(mouth.cap.normal);
      if (nearest >= 0 && away >= nearest) continue;
      nearest = away;
      share = depth + ahead > 0 ? std::clamp(depth / (depth + ahead), 0.0, 1.0) : 0.5;
    }
    length += share * spacing;
  }
  return length;
}

}  // namespace palpate
