// How a patch is laid on the surface under its sphere.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/contact/patch/overlap_normal.hpp"
#include "common/contact/patch/patch.hpp"
#include "common/contact/patch/surface_place.hpp"
#include "common/geometry/direction.hpp"

namespace palpate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Radii deep, up to which pressures act along one normal, as where they lie in less than two squares' width there is
// none to lean by; and from which on they lean as the ball does.
constexpr double kUpright = 1 / 16.0, kLeaning = 1 / 4.0;
constexpr double kLookAround = 1.5;  // radii about the sphere's middle, and as much more as it is deep,
constexpr double kDeepest = 4;       // up to so many radii; about a deeper one, along all its way out
constexpr int kTurnsToPassed = 40;   // at most, of the normal towards what the sphere has passed, where it comes anew
constexpr double kOnEdge = 1e-6;     // radii, by which a foot may lie outside of a triangle's box

// A direction across `normal` that goes along with the tool: the tool's own x axis, brought over by the least turn that
// takes its z axis into the tissue.
Vector3d across_of(const Eigen::Isometry3d& tool, const Vector3d& normal) {
  return turn_between(tool.linear().col(2), normal) * tool.linear().col(0);
}

}  // namespace

int Patch::local(int node) {
  const auto found = std::ranges::find(nodes_, node);
  if (found != nodes_.end()) return static_cast<int>(found - nodes_.begin());
  nodes_.push_back(node);
  return static_cast<int>(nodes_.size()) - 1;
}

std::span<const int> Patch::lay(const Ground& ground, const Eigen::Isometry3d& before, const Eigen::Isometry3d& now,
                                const Segment& axis, double above) {
  near_ = near(ground.surface, axis);
  nodes_.clear();
  for (Cell& cell : cells_) cell = {.gap = -std::numeric_limits<double>::infinity()};
  laid_at_ = axis.start;
  above_ = above;
  back_ = before * now.inverse();
  if (grid_.strip()) {
    if (find_along(ground, axis)) lay_strip(ground);
  } else if (find_below(ground, axis.start, above)) {
    across_ = across_of(now, normal_);
    up_ = normal_.cross(across_);
    lay_middles();
    lay_feet(ground, lay_rims(ground) ? 0.5 * grid_.edge() : 0.0);
    lay_squares(ground);
  }
  double depth = -std::numeric_limits<double>::infinity();
  for (const Cell& cell : cells_) depth = std::max(depth, cell.gap);
  depth_ = std::max(depth, 0.0);
  leans_ = share_leaning();
  push_ = normal_;
  at_ = place_of_force();
  lost_ = 0;
  for (int p = 0; p < grid_.size() && touches(); ++p)
    if (!laid(p)) lost_ += pressure_force_[p] / pressing_;
  if (nodes_.empty() || depth <= -above) lift();
  return nodes_;
}

// By the depth at which a sphere has as much volume below a plane as this one has in tissue.
double Patch::share_leaning() const {
  double heights = 0;  // [m]
  for (const Cell& cell : cells_) heights += cell.cover * std::max(cell.gap, 0.0);
  const double deep = grid_.edge() / grid_.radius() * std::sqrt(heights / (std::numbers::pi * grid_.radius()));
  const double s = std::clamp((deep - kUpright) / (kLeaning - kUpright), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

std::span<int> Patch::near(const SmoothSurface& surface, const Segment& axis) const {
  const double around = kLookAround * grid_.radius(), deepest = kDeepest * grid_.radius();
  if (grid_.strip()) return surface.near(axis, around + depth_);
  if (depth_ <= deepest) return surface.near(axis.start, around + depth_);
  const Segment way_out{axis.start, axis.start - (depth_ - deepest) * normal_};
  return surface.near(way_out, around + deepest);
}

// The patch faces what the sphere has passed of the surface. Above it, it faces the surface where the line through the
// sphere's middle along its normal meets it: found from where it faced a step ago, or from the nearest point of what
// comes within the sphere.
bool Patch::find_below(const Ground& ground, const Vector3d& middle, double above) {
  const SmoothSurface& surface = ground.surface;
  Vector3d out = -normal_, weights;
  if (!touches()) {
    double least = std::pow(grid_.radius() + above, 2);
    int nearest = -1;
    for (const int t : near_) {
      const ClosestPoint p = closest_point(middle, surface.corners(t));
      if (p.squared_distance >= least) continue;
      least = p.squared_distance;
      nearest = t;
      weights = p.weights;
    }
    if (nearest < 0) return false;
    anchor_ = {surface.map().triangles[nearest], weights};
    out = surface.normal(nearest, weights);
  }
  bool overlaps = false;
  for (int turn = 0; turn < (touches() ? 1 : kTurnsToPassed); ++turn) {
    const Vector3d passed = overlap_normal(surface, near_, middle, grid_.radius(), out, kFacing);
    if (passed.squaredNorm() == 0) break;
    const Vector3d before = std::exchange(out, passed.normalized());
    overlaps = true;
    if ((out - before).squaredNorm() < 1e-12) break;
  }
  for (int turn = 0; turn < kTurns; ++turn) {
    const auto below = highest_along(surface, near_, middle, out, kFacing);
    if (!below) break;
    anchor_ = {surface.map().triangles[below->triangle], below->weights};
    if (overlaps) break;
    const Vector3d next = surface.normal(below->triangle, below->weights);
    const bool done = (next - out).squaredNorm() < 1e-20;
    out = next;
    if (done) break;
  }
  normal_ = -out;
  return true;
}

Vector3d Patch::in_plane(const Vector3d& p) const {
  const Vector3d d = p - laid_at_;
  return {across_.dot(d), up_.dot(d), normal_.dot(d)};
}

std::array<Vector3d, 3> Patch::seen_in_plane(const Ground& ground, int t) const {
  const Triangle c = ground.surface.corners(t);
  return {in_plane(c[0]), in_plane(c[1]), in_plane(c[2])};
}

Vector2d Patch::foot_middle(int foot) const {
  if (!grid_.strip()) return grid_.middle(foot);
  if (grid_.column_feet()) return {cell_middle(foot), 0};
  return {cell_middle(grid_.column(foot)), grid_.across(grid_.row(foot))};
}

void Patch::lay_middles() {
  for (int i = 0; i < grid_.feet(); ++i) foot_middle_[i] = foot_middle(i);
}

// Where the lines through the feet along the normal meet the surface; the outermost place counts. `aside` [m]: by which
// a sphere's foot may stand from the middle of its column.
void Patch::lay_feet(const Ground& ground, double aside) {
  const SmoothSurface& surface = ground.surface;
  for (Foot& f : feet_) f = {.depth = std::numeric_limits<double>::infinity()};
  for (const int t : near_) {
    if (grid_.strip() ? !presses(ground, t) : !may_lie_below(ground, t, aside)) continue;
    const std::array<Vector3d, 3> flat = seen_in_plane(ground, t);
    if (grid_.column_feet() && (flat[0].y() < 0) == (flat[1].y() < 0) && (flat[1].y() < 0) == (flat[2].y() < 0))
      continue;
    const Vector2d low = flat[0].cwiseMin(flat[1]).cwiseMin(flat[2]).head<2>().array() - kOnEdge * grid_.radius();
    const Vector2d high = flat[0].cwiseMax(flat[1]).cwiseMax(flat[2]).head<2>().array() + kOnEdge * grid_.radius();
    const Vector2d e1 = (flat[1] - flat[0]).head<2>(), e2 = (flat[2] - flat[0]).head<2>();
    const double twice = e1.x() * e2.y() - e1.y() * e2.x();
    for (int column = 0; column < grid_.columns(); ++column) {
      const int first = grid_.first_foot(column), last = grid_.first_foot(column + 1) - 1;
      const double x = foot_middle(first).x();
      if (x + aside < low.x()) continue;
      if (x - aside > high.x()) break;
      for (int i = first; i <= last; ++i) {
        const Vector2d& middle = foot_middle_[i];
        if ((middle - low).minCoeff() < 0 || (high - middle).minCoeff() < 0) continue;
        const Vector2d d = middle - flat[0].head<2>();
        const double w1 = (d.x() * e2.y() - d.y() * e2.x()) / twice, w2 = (e1.x() * d.y() - e1.y() * d.x()) / twice;
        if (w1 < -1e-9 || w2 < -1e-9 || w1 + w2 > 1 + 1e-9) continue;
        const Vector3d w(1 - w1 - w2, w1, w2);
        const double depth = w[0] * flat[0].z() + w[1] * flat[1].z() + w[2] * flat[2].z();
        if (depth >= feet_[i].depth) continue;
        feet_[i] = {.triangle = t, .weights = w, .depth = depth};
      }
    }
  }
  stand_on_triangles(surface.map());
}

void Patch::stand_on(const SurfaceMap& map, Foot& foot) {
  for (int v = 0; v < 3; ++v) foot.local[v] = local(map.triangles[foot.triangle][v]);
}

// Nodes come in the order of the triangles' numbers.
void Patch::stand_on_triangles(const SurfaceMap& map) {
  std::array<int, kMaxCells> order;
  int standing = 0;
  for (int i = 0; i < grid_.feet(); ++i)
    if (feet_[i].stands()) order[standing++] = i;
  std::sort(order.begin(), order.begin() + standing,
            [&](int a, int b) { return feet_[a].triangle < feet_[b].triangle; });
  for (const int i : std::span(order).first(standing)) stand_on(map, feet_[i]);
}

double Patch::facing(const Ground& ground, int t) const {
  return -ground.surface.facet_normal(t).dot(normal_);
}

bool Patch::presses(const Ground& ground, int t) const {
  return facing(ground, t) >= kFacing && (!grid_.strip() || ground.surface.touchable(t));
}

// Of the triangles that are near a sphere, one that a square of it may lie over: within its radius and so much more.
bool Patch::may_lie_below(const Ground& ground, int t, double more) const {
  return presses(ground, t) && ground.surface.may_meet(t, laid_at_, normal_, grid_.radius() + more);
}

// A sphere's squares stand on their own feet.
void Patch::lay_squares(const Ground& ground) {
  for (int p = 0; p < grid_.size(); ++p) {
    Cell& cell = cells_[p];
    if (cell.cover < kMinCover) continue;
    if (!feet_[p].stands() && cell.cover < 1) stand_on_nearest(ground, p);  // in the middle of parts
    const double depth = feet_[p].depth;
    if (!std::isfinite(depth)) continue;
    const Vector2d& at = foot_middle_[p];
    const double rise =
        cell.cover < 1 ? std::sqrt(std::max(0.0, std::pow(grid_.radius(), 2) - at.squaredNorm())) : grid_.rise(p);
    cell.gap = rise - depth;
    cell.at = laid_at_ + at.x() * across_ + at.y() * up_ + depth * normal_;
  }
}

}  // namespace palpate
