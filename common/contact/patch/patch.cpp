#include "common/contact/patch/patch.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/barycentric.hpp"
#include "common/geometry/direction.hpp"

namespace palpate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSquaresPerRadius = 4;   // 44 squares in all
constexpr double kWidth = 0.95;           // of the radius: beyond it the sphere is too steep to press
constexpr double kLookAround = 1.5;       // radii about the sphere's middle, and as much more as it is deep,
constexpr double kDeepest = 4;            // up to so many radii
constexpr double kFacing = 0.2;           // cosine between a facet's normal and the patch's, below which it lies aside
constexpr int kTurns = 6;                 // at most, of the normal towards that below the sphere's middle
constexpr int kPasses = 24;               // at most, of the active set
constexpr double kTouchTolerance = 1e-9;  // [m]
constexpr double kPivotShare =
    0.05;  // of a square's own compliance, to which pivots are raised: a half-space leaves more

// A direction across `normal` that goes along with the tool: the tool's own x axis, brought over by the least turn that
// takes its z axis into the tissue.
Vector3d across_of(const Eigen::Isometry3d& tool, const Vector3d& normal) {
  return turn_between(tool.linear().col(2), normal) * tool.linear().col(0);
}

}  // namespace

PatchGrid::PatchGrid(double radius, const HalfSpace& half_space) : radius_(radius), edge_(radius / kSquaresPerRadius) {
  const int side = static_cast<int>(2 * kWidth * kSquaresPerRadius);
  for (int i = 0; i <= side; ++i)
    for (int j = 0; j <= side; ++j) {
      const Vector2d at = edge_ * Vector2d(i - 0.5 * side, j - 0.5 * side);
      if (at.norm() < kWidth * radius) middle_.push_back(at);
    }
  for (const Vector2d& at : middle_) rise_.push_back(std::sqrt(radius * radius - at.squaredNorm()));
  const double per_force = 1 / (edge_ * edge_);
  for (const Vector2d& p : middle_)
    for (const Vector2d& q : middle_) {
      const Vector2d d = p - q;
      pressed_.push_back(per_force * half_space.pressed(d.x(), d.y(), edge_));
      sheared_.push_back(per_force * half_space.sheared(d.x(), d.y(), edge_));
    }
}

Patch::Patch(const PatchGrid& grid, const std::optional<CreepStep>& creep) : grid_(grid) {
  if (creep) memory_.emplace(grid, *creep);
  const std::size_t points = grid.size();
  normal_ = Vector3d::UnitZ();
  across_ = up_ = at_ = force_ = travel_ = Vector3d::Zero();
  feet_.resize(points);
  active_.assign(points, 0);
  wanted_.assign(points, 0.0);
  pressure_force_.assign(points, 0.0);
  compliance_.assign(points * points, 0.0);
  const auto ld = static_cast<std::size_t>(kernels::leading_dimension(static_cast<int>(points)));
  factor_.assign(ld * ld, 0.0);
  right_.assign(ld, 0.0);
  floor_.assign(ld, 0.0);
  rows_.reserve(points);
  nodes_.reserve(kMaxNodes);
  known_.reserve(kMaxNodes);
  near_field_.assign(kMaxNodes * kMaxNodes, Eigen::Matrix3d::Zero());
  k_.assign(kMaxNodes * kMaxNodes, 0.0);
  k_phi_.assign(kMaxNodes * points, 0.0);
}

void Patch::lift() {
  nodes_.clear();
  loaded_ = 0;
  std::ranges::fill(active_, 0);
  bent_.setZero();
  force_.setZero();
  pressing_ = depth_ = 0;
  if (memory_) memory_->forget();
}

int Patch::local(int node) {
  const auto found = std::ranges::find(nodes_, node);
  if (found != nodes_.end()) return static_cast<int>(found - nodes_.begin());
  if (static_cast<int>(nodes_.size()) == kMaxNodes) return -1;
  nodes_.push_back(node);
  return static_cast<int>(nodes_.size()) - 1;
}

std::span<const int> Patch::lay(const Ground& ground, const Eigen::Isometry3d& before, const Eigen::Isometry3d& now,
                                const Vector3d& middle) {
  near_ = ground.surface.near(middle, kLookAround * grid_.radius() + std::min(depth_, kDeepest * grid_.radius()));
  nodes_.clear();
  if (find_below(ground, middle)) {
    turn_to(before, now, middle);
    lay_feet(ground, middle);
  }
  depth_ = 0;
  for (const Foot& f : feet_) depth_ = std::max(depth_, f.gap);
  if (nodes_.empty() || depth_ <= 0) lift();
  return nodes_;
}

// The patch faces the surface where the line through the sphere's middle along its normal meets it: found from where it
// faced a step ago, or from the nearest point of what comes within the sphere.
bool Patch::find_below(const Ground& ground, const Vector3d& middle) {
  const SmoothSurface& surface = ground.surface;
  Vector3d out = -normal_, weights;
  if (!touches()) {
    double least = grid_.radius() * grid_.radius();
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
  for (int turn = 0; turn < kTurns; ++turn) {
    int below = -1;
    double highest = -std::numeric_limits<double>::infinity();
    for (const int t : near_) {
      const double facing = surface.facet_normal(t).dot(out);
      if (facing < kFacing) continue;
      const Triangle c = surface.corners(t);
      const double s = surface.facet_normal(t).dot(c[0] - middle) / facing;
      const Vector3d w = plane_coordinates(c, middle + s * out);
      if (w.minCoeff() < -1e-9 || s < highest) continue;
      highest = s;
      below = t;
      weights = w;
    }
    if (below < 0) break;
    anchor_ = {surface.map().triangles[below], weights};
    const Vector3d next = surface.normal(below, weights);
    const bool done = (next - out).squaredNorm() < 1e-20;
    out = next;
    if (done) break;
  }
  normal_ = -out;
  return true;
}

void Patch::turn_to(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, const Vector3d& middle) {
  across_ = across_of(now, normal_);
  up_ = normal_.cross(across_);
  at_ = middle + grid_.radius() * normal_;
  travel_ = at_ - before * (now.inverse() * at_);
}

// Where the lines through the squares along the normal meet the surface; the outermost place counts.
void Patch::lay_feet(const Ground& ground, const Vector3d& middle) {
  const SmoothSurface& surface = ground.surface;
  for (Foot& f : feet_) f.gap = -std::numeric_limits<double>::infinity();
  for (const int t : near_) {
    if (-surface.facet_normal(t).dot(normal_) < kFacing) continue;
    const Triangle c = surface.corners(t);
    std::array<Vector2d, 3> flat;
    for (int v = 0; v < 3; ++v) flat[v] = {across_.dot(c[v] - middle), up_.dot(c[v] - middle)};
    const Vector2d e1 = flat[1] - flat[0], e2 = flat[2] - flat[0];
    const double twice = e1.x() * e2.y() - e1.y() * e2.x();
    std::array<int, 3> corners{-2, -2, -2};
    for (int p = 0; p < grid_.size(); ++p) {
      const Vector2d d = grid_.middle(p) - flat[0];
      const double w1 = (d.x() * e2.y() - d.y() * e2.x()) / twice, w2 = (e1.x() * d.y() - e1.y() * d.x()) / twice;
      if (w1 < -1e-9 || w2 < -1e-9 || w1 + w2 > 1 + 1e-9) continue;
      const Vector3d w(1 - w1 - w2, w1, w2);
      const double gap = normal_.dot(middle - (w[0] * c[0] + w[1] * c[1] + w[2] * c[2])) + grid_.rise(p);
      if (gap <= feet_[p].gap) continue;
      for (int v = 0; v < 3 && corners[v] == -2; ++v) corners[v] = local(surface.map().triangles[t][v]);
      if (std::ranges::min(corners) >= 0) feet_[p] = {corners, w, gap};
    }
  }
}

void Patch::press(const Ground& ground, std::span<const Vector3d> moved) {
  for (int p = 0; p < grid_.size(); ++p) {
    const Foot& f = feet_[p];
    wanted_[p] = f.gap;
    if (!std::isfinite(f.gap)) {
      active_[p] = 0;
      continue;
    }
    for (int v = 0; v < 3; ++v) wanted_[p] -= f.weights[v] * normal_.dot(moved[f.local[v]]);
    if (memory_) wanted_[p] -= memory_->dent(p);
  }
  fill_near_field(ground.near_field);
  fill_normal();
  settle_pressures();
  pressing_ = 0;
  for (const double f : pressure_force_) pressing_ += f;
  const Vector3d bent_before = bent_;
  shear(ground);
  if (memory_) add_slip(bent_before);
}

// What of its way the tip has not taken the tissue along.
void Patch::add_slip(const Vector3d& bent_before) {
  const Vector3d slip = travel_ - (bent_ - bent_before);
  slip_ = {across_.dot(slip), up_.dot(slip)};
}

void Patch::remember(std::span<const Vector3d> moved) {
  if (!memory_) return;
  const int n = grid_.size();
  const double elastic = 1 / memory_->instant();
  for (int p = 0; p < n; ++p) {
    const Foot& f = feet_[p];
    wanted_[p] = 0;
    if (!std::isfinite(f.gap)) continue;
    for (const int q : rows_) wanted_[p] += elastic * compliance_[p * n + q] * pressure_force_[q];
    for (int v = 0; v < 3; ++v) wanted_[p] -= elastic * f.weights[v] * normal_.dot(moved[f.local[v]]);
  }
  memory_->follow(wanted_, elastic * sheared_);
  memory_->slip(slip_, grid_.edge() * std::sqrt(static_cast<double>(rows_.size())));
}

// From one step to the next the nodes are mostly the same.
void Patch::fill_near_field(const NearField& near_field) {
  if (nodes_ == known_) return;
  known_ = nodes_;
  const int count = static_cast<int>(nodes_.size());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j <= i; ++j) {
      const Eigen::Matrix3d block = near_field.between(nodes_[i], nodes_[j]);
      near_field_[i * kMaxNodes + j] = block;
      near_field_[j * kMaxNodes + i] = block.transpose();
    }
}

// The compliance between squares along the normal [m/N].
void Patch::fill_normal() {
  const int n = grid_.size(), count = static_cast<int>(nodes_.size());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j <= i; ++j)
      k_[i * kMaxNodes + j] = k_[j * kMaxNodes + i] = normal_.dot(near_field_[i * kMaxNodes + j] * normal_);
  for (int p = 0; p < n; ++p) {
    const Foot& f = feet_[p];
    if (!std::isfinite(f.gap)) continue;
    for (int i = 0; i < count; ++i) {
      double sum = 0;
      for (int v = 0; v < 3; ++v) sum += f.weights[v] * k_[i * kMaxNodes + f.local[v]];
      k_phi_[p * kMaxNodes + i] = sum;
    }
  }
  for (int p = 0; p < n; ++p) {
    if (!std::isfinite(feet_[p].gap)) continue;
    for (int q = 0; q <= p; ++q) {
      const Foot& f = feet_[q];
      if (!std::isfinite(f.gap)) continue;
      double sum = grid_.pressed(p, q);
      for (int v = 0; v < 3; ++v) sum += f.weights[v] * k_phi_[p * kMaxNodes + f.local[v]];
      compliance_[p * n + q] = compliance_[q * n + p] = sum;
    }
  }
}

// p >= 0, A p >= wanted, one of them an equality; from the last step's active set.
void Patch::settle_pressures() {
  const int n = grid_.size();
  bool changed = true;
  for (int pass = 0; changed && pass < kPasses; ++pass) {
    if (!solve_active()) break;
    changed = false;
    double largest = 0;
    for (const double f : pressure_force_) largest = std::max(largest, f);
    for (int p = 0; p < n; ++p) {
      if (!std::isfinite(feet_[p].gap)) continue;
      if (active_[p]) {
        if (pressure_force_[p] < -1e-12 * largest) active_[p] = 0, changed = true;
        continue;
      }
      double moved = 0;
      for (const int q : rows_) moved += compliance_[p * n + q] * pressure_force_[q];
      if (moved < wanted_[p] - kTouchTolerance) active_[p] = 1, changed = true;
    }
  }
  for (double& f : pressure_force_) f = std::max(f, 0.0);
}

bool Patch::solve_active() {
  const int n = grid_.size();
  const std::ptrdiff_t ld = kernels::leading_dimension(n);
  rows_.clear();
  std::ranges::fill(pressure_force_, 0.0);
  for (int p = 0; p < n; ++p)
    if (active_[p]) rows_.push_back(p);
  const int m = static_cast<int>(rows_.size());
  if (m == 0) return true;
  for (int c = 0; c < m; ++c) {
    for (int r = c; r < m; ++r) factor_[ld * c + r] = compliance_[rows_[r] * n + rows_[c]];
    floor_[c] = kPivotShare * grid_.pressed(0, 0);
    right_[c] = wanted_[rows_[c]];
  }
  kernels::active().cholesky(factor_.data(), m, ld, floor_.data());
  kernels::active().cholesky_solve(factor_.data(), m, ld, right_.data());
  for (int c = 0; c < m; ++c) pressure_force_[rows_[c]] = right_[c];
  return std::isfinite(right_[0]);
}

// One shear force, spread as the pressures are. The tissue is bent along until Coulomb's bound is met; from there it
// slips and stays bent as far as the bound allows, so that the shear never turns against the travel.
void Patch::shear(const Ground& ground) {
  loaded_ = 0;
  sheared_.setZero();
  if (pressing_ <= 0) {
    bent_.setZero();
    force_.setZero();
    return;
  }
  const int n = grid_.size(), count = static_cast<int>(nodes_.size());
  std::array<double, kMaxNodes> share{};
  for (int p = 0; p < n; ++p)
    for (int v = 0; v < 3 && pressure_force_[p] > 0; ++v)
      share[feet_[p].local[v]] += feet_[p].weights[v] * pressure_force_[p] / pressing_;
  Vector3d shear = Vector3d::Zero();
  if (ground.friction > 0) {
    Eigen::Matrix<double, 3, 2> plane;
    plane << across_, up_;
    Eigen::Matrix2d c = Eigen::Matrix2d::Zero();
    for (const int p : rows_)
      for (const int q : rows_) c += pressure_force_[p] * pressure_force_[q] * grid_.sheared(p, q);
    c /= pressing_ * pressing_;
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j)
        if (share[i] != 0 && share[j] != 0)
          c += share[i] * share[j] * plane.transpose() * near_field_[i * kMaxNodes + j] * plane;
    const Vector3d past = memory_ ? memory_->bent() : Vector3d::Zero();
    Vector2d bent = plane.transpose() * (bent_ + travel_ - past);
    if (!resumed_.isZero(0)) bent = c * plane.transpose() * resumed_;
    resumed_.setZero();
    Vector2d force = c.inverse() * bent;
    const double most = ground.friction * pressing_, size = force.norm();
    sticks_ = size <= most;
    if (!sticks_) force *= most / size, bent = c * force;
    sheared_ = bent_ = plane * bent;
    if (memory_) bent_ += past - past.dot(normal_) * normal_;
    shear = plane * force;
  }
  force_ = pressing_ * normal_ + shear;
  for (int i = 0; i < count; ++i)
    if (share[i] != 0) forces_[loaded_++] = {nodes_[i], share[i] * force_};
}

bool Patch::fits(int nodes) const {
  const auto known = [&](int node) { return node >= 0 && node < nodes; };
  return loaded_ >= 0 && loaded_ <= kMaxNodes && std::ranges::all_of(anchor_.nodes, known) &&
         std::ranges::all_of(forces(), known, &PatchForce::node);
}

void Patch::state(State& s) {
  s.all(active_);
  s.value(bent_);
  s.value(resumed_);
  s.value(force_);
  s.value(pressing_);
  s.value(depth_);
  s.value(normal_);
  s.value(at_);
  s.value(anchor_.nodes);
  s.value(anchor_.weights);
  s.value(sticks_);
  if (memory_) memory_->state(s);
  for (PatchForce& f : forces_) {
    s.value(f.node);
    s.value(f.force);
  }
  s.value(loaded_);
}

}  // namespace palpate
