#include "common/models/catheter/wall_touches.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace palpate {

using Eigen::Vector3d;

namespace {

constexpr double kOtherSide = 0.5;   ///< cosine below which two directions are clearly different
constexpr double kFaster = 1.5;      ///< [1] what a wall may move by in a tick against what is expected
constexpr double kHeldBefore = 0.1;  ///< [1] of its distance: how close before the wall a particle is held
constexpr double kInFront = 0.7;     ///< cosine above which a triangle faces a point

}  // namespace

WallTouches::WallTouches(int particles, const DuctWall* wall, double radius, double friction)
    : wall_(wall), wall_motion_(wall), friction_(friction), past_(particles) {
  if (!wall_) return;
  reach_ = radius + wall_->half_thickness();
  margin_ = 0.1 * reach_;
  planes_.reserve(wall_->surface().triangle_count());
}

/// Nearest point of a triangle with area, and its squared distance: where the foot of the perpendicular lies
/// beyond an edge, it is on such an edge.
ClosestPoint WallTouches::closest(const Vector3d& x, const Triangle& c, const Vector3d& normal, double square) {
  ClosestPoint best{Vector3d::Zero(), -1};
  const Vector3d from[3] = {x - c[0], x - c[1], x - c[2]};
  for (int v = 0; v < 3; ++v) best.weights[v] = from[(v + 1) % 3].cross(from[(v + 2) % 3]).dot(normal) / square;
  if (best.weights.minCoeff() > 0) {
    const double height = from[0].dot(normal);
    best.squared_distance = height * height / square;
    return best;
  }
  const Vector3d beyond = best.weights;
  for (int v = 0; v < 3; ++v) {
    if (beyond[v] > 0) continue;
    const int i = (v + 1) % 3, j = (v + 2) % 3;
    const Vector3d edge = c[j] - c[i];
    const double along = std::clamp(from[i].dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    const double squared = (from[i] - along * edge).squaredNorm();
    if (best.squared_distance >= 0 && squared >= best.squared_distance) continue;
    best.weights.setZero();
    best.weights[i] = 1 - along;
    best.weights[j] = along;
    best.squared_distance = squared;
  }
  return best;
}

/// Takes up the triangles' planes and finds the nearest triangle within a distance of x. Of those equally
/// near, which share an edge or a corner, the one that faces x most tells its side. A triangle is no nearer
/// than its plane.
bool WallTouches::find_nearest(const Vector3d& x, std::span<const int> triangles, double within, Near& best) {
  planes_.clear();
  const TouchSurface& surface = wall_->surface();
  const double tie = 1e-9 * reach_;
  best = {.distance = within};
  for (const int t : triangles) {
    const Triangle c = surface.corners(t);
    const Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
    const double height = normal.dot(x - c[0]), square = normal.squaredNorm();
    if (!(square > 0) || height * height > within * within * square) continue;
    planes_.push_back({t, normal, square});
    const double most = best.distance + tie;
    if (height * height > most * most * square) continue;
    const Near near = nearest_on(planes_.back(), x);
    if (near.distance < best.distance - tie ||
        (near.distance < most && (best.triangle < 0 || std::abs(near.facing) > std::abs(best.facing))))
      best = near;
  }
  return best.triangle >= 0;
}

WallTouches::Near WallTouches::nearest_on(const Plane& plane, const Vector3d& x) const {
  const Triangle c = wall_->surface().corners(plane.triangle);
  const ClosestPoint point = closest(x, c, plane.normal, plane.square);
  Near near;
  near.triangle = plane.triangle;
  near.weights = point.weights;
  near.q = point.weights[0] * c[0] + point.weights[1] * c[1] + point.weights[2] * c[2];
  near.outward = plane.normal / std::sqrt(plane.square);
  near.distance = std::sqrt(point.squared_distance);
  near.facing = near.outward.dot(x - near.q);
  return near;
}

/// The nearest triangle within a distance that the particle has before it in a direction clearly other than
/// `normal`.
bool WallTouches::find_opposite(const Vector3d& x, const Vector3d& normal, double side, double within,
                                Near& best) const {
  best = {.distance = within};
  for (const Plane& plane : planes_) {
    const double along = side * plane.normal.dot(normal);
    if (along > 0 && along * along > kOtherSide * kOtherSide * plane.square) continue;
    const Near near = nearest_on(plane, x);
    if (side * near.facing >= kInFront * near.distance && near.distance < best.distance) best = near;
  }
  return best.triangle >= 0;
}

/// Direction in which the nearest point pushes, and the distance along it: below zero where the particle has
/// passed through. Returns the side on which it meets the wall, 1 outside and -1 inside. A particle that has
/// come past the rim beside the mouth has left the lumen; one that is before the mouth meets the inner side
/// where that is nearest.
double WallTouches::direction(int particle, const Vector3d& x, const Near& near, Lumen& lumen, Vector3d& normal,
                              double& distance) const {
  const int rim = lumen.rim_at(near.triangle, near.weights);
  if (lumen.inside()[particle] && rim >= 0 && lumen.past_rim(rim, x, near.q)) lumen.leave(particle);
  const bool inner = lumen.inside()[particle] || (near.facing < 0 && lumen.before_mouth(x));
  const double side = inner ? -1 : 1;
  const Vector3d away = x - near.q;
  const bool flat = near.weights.minCoeff() > 0 || near.distance < 1e-6 * reach_;
  const double sign = rim >= 0 || side * near.facing >= 0 ? 1 : -1;  // a rim has no inner and no outer side
  normal = flat ? Vector3d(side * near.outward) : Vector3d(away * (sign / near.distance));
  distance = flat ? side * near.facing : sign * near.distance;
  return side;
}

CatheterTouch WallTouches::touch_at(int particle, const Near& near, const Vector3d& normal, double distance) const {
  CatheterTouch touch;
  const int last = static_cast<int>(past_.size()) - 1;
  touch.point = particle == last ? ChainPoint{last - 1, 1} : ChainPoint{particle, 0};
  touch.normal = normal;
  touch.anchor = {wall_->surface().triangle(near.triangle), near.weights};
  // Beyond `most` a stiffer spring continues the soft one: its tangent there, and the overlap that gives its force.
  const double most = kLedBack * reach_, deeper = std::clamp(reach_ - distance - most, 0.0, most);
  const double overlap = deeper > 0 ? most / kStiffening + deeper : reach_ - distance;
  touch.overlap = overlap - normal.dot(wall_->residual_motion(touch.anchor));
  touch.compliance = deeper > 0 ? kCompliance / kStiffening : kCompliance;
  touch.friction = friction_;
  touch.grip = friction_ * past_force(particle, normal);
  touch.on_wall = true;
  touch.at = near.q;
  return touch;
}

double WallTouches::past_force(int particle, const Vector3d& normal) const {
  double force = 0, best = kOtherSide;
  for (const Past& past : past_[particle]) {
    if (past.normal.dot(normal) <= best) continue;
    best = past.normal.dot(normal);
    force = past.normal_force;
  }
  return force;
}

void WallTouches::find(std::span<const Vector3d> x, std::span<const Vector3d> v, double h, Lumen& lumen,
                       CoupledSolve& solve) {
  if (!wall_) return;
  travel_ = kFaster * wall_motion_.expected();
  for (int i = 0; i < static_cast<int>(x.size()); ++i) {
    const double within = reach_ + margin_ + travel_ + h * v[i].norm();
    Near near, other;
    if (!find_nearest(x[i], wall_->surface().find(x[i], x[i] + h * v[i], reach_ + margin_ + travel_), within, near))
      continue;
    Vector3d normal;
    double distance;
    const double side = direction(i, x[i], near, lumen, normal, distance);
    solve.add(touch_at(i, near, normal, distance));
    if (!find_opposite(x[i], normal, side, within, other)) continue;
    solve.add(touch_at(i, other, side * other.outward, side * other.facing));
  }
}

std::optional<WallTouches::Passage> WallTouches::passage(int particle, const Vector3d& x, const Vector3d& motion,
                                                         const Lumen& lumen) {
  std::optional<Passage> first;
  if (motion.norm() + travel_ < margin_) return first;
  const TouchSurface& surface = wall_->surface();
  for (const int t : surface.find(x, x + motion, travel_)) {
    const Triangle now = wall_motion_.now(t);
    const auto hit = sweep_point(x, x + motion, wall_motion_.before(t), now);
    if (!hit || (first && first->time <= hit->time)) continue;
    Near near;
    near.triangle = t;
    near.weights = hit->weights;
    const Triangle c = surface.corners(t);
    near.q = hit->weights[0] * c[0] + hit->weights[1] * c[1] + hit->weights[2] * c[2];
    const Vector3d then = hit->weights[0] * now[0] + hit->weights[1] * now[1] + hit->weights[2] * now[2];
    const auto mouth = lumen.crossing(x, x + motion - (then - near.q));
    const bool inside = mouth && mouth->time < hit->time ? mouth->from_outside : lumen.inside()[particle] != 0;
    if (hit->from_outside == inside) continue;  // on its way back to the side where it belongs
    const double side = inside ? -1 : 1;
    const Vector3d normal = side * surface.triangle_normal(t).normalized();
    const Vector3d then_normal = side * (now[1] - now[0]).cross(now[2] - now[0]).normalized();
    const double distance = normal.dot(x - near.q);
    first = {hit->time, touch_at(particle, near, normal, distance),
             then + kHeldBefore * std::clamp(distance, 0.0, reach_) * then_normal};
  }
  return first;
}

void WallTouches::keep(std::span<const CatheterTouch> touches) {
  std::fill(past_.begin(), past_.end(), std::array<Past, 2>{});
  for (const CatheterTouch& t : touches) {
    if (!t.on_wall) continue;
    auto& past = past_[t.point.segment + (t.point.along == 1)];
    Past& slot = past[0].normal_force <= past[1].normal_force ? past[0] : past[1];
    if (t.normal_force > slot.normal_force) slot = {t.normal, t.normal_force};
  }
}

}  // namespace palpate
