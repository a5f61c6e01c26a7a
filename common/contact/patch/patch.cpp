#include "common/contact/patch/patch.hpp"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kPasses = 24;               // at most, of the active set
constexpr double kTouchTolerance = 1e-9;  // [m]
using PerCell = Eigen::Array<double, Eigen::Dynamic, 1, 0, Patch::kMaxCells, 1>;
constexpr double kPivotShare = 0.05;  // of a square's own compliance, to which pivots are raised: G leaves more

}  // namespace

Patch::Patch(const PatchGrid& grid, const std::optional<CreepStep>& creep)
    : grid_(grid), max_nodes_(3 * grid.feet()), nodes_give_(max_nodes_), kernel_(grid), near_field_(max_nodes_) {
  if (creep) memory_.emplace(grid, *creep);
  const std::size_t points = grid.size();
  normal_ = Vector3d::UnitZ();
  across_ = up_ = at_ = force_ = travel_ = Vector3d::Zero();
  cells_.resize(points);
  cell_length_ = grid.edge();
  feet_.resize(grid.feet());
  foot_middle_.resize(grid.feet());
  active_.assign(points, 0);
  wanted_.assign(points, 0.0);
  pressure_force_.assign(points, 0.0);
  compliance_.assign(points * points, 0.0);
  const auto ld = static_cast<std::size_t>(kernels::leading_dimension(static_cast<int>(points)));
  factor_.assign(ld * ld, 0.0);
  right_.assign(ld, 0.0);
  floor_.assign(ld, 0.0);
  rows_.reserve(points);
  nodes_.reserve(max_nodes_);
  lifted_.reserve(max_nodes_);
  lift_.assign(points, 0.0);
  known_.reserve(max_nodes_);
  place_.reserve(max_nodes_);
  for (std::vector<double>& moved : moved_places_) moved.assign(max_nodes_, 0.0);
  direction_.assign(grid.feet(), normal_);
  k_feet_.assign(grid.feet() * grid.feet(), 0.0);
  forces_.resize(max_nodes_);
}

void Patch::lift() {
  nodes_.clear();
  loaded_ = 0;
  std::ranges::fill(active_, 0);
  bent_.setZero();
  resumed_.setZero();
  force_.setZero();
  shear_.setZero();
  pressing_ = depth_ = 0;
  if (memory_) memory_->forget();
}

void Patch::press(const Ground& ground, std::span<const Vector3d> moved, double less) {
  fill_near_field(ground.near_field);
  fill_normal();
  lift_cells(ground, {});
  for (int p = 0; p < grid_.size(); ++p) {
    wanted_[p] = cells_[p].gap - cells_[p].dent - less;
    if (!laid(p)) {
      active_[p] = 0;
      continue;
    }
    wanted_[p] -= rise(grid_.foot(p), moved) + lift_[p];
    if (memory_) wanted_[p] -= memory_->dent(p);
  }
  settle_pressures();
  sum_pressures();
  at_ = place_of_force();
  travel_ = at_ - back_ * at_;
  const Vector3d bent_before = bent_;
  shear(ground, {travel_, {}, {}});
  if (memory_) add_slip(bent_before);
}

// [m] Along a segment's first axis.
double Patch::middle_of_pressure() const {
  if (!grid_.strip()) return 0;
  if (!(pressing_ > 0)) return window_ + 0.5 * grid_.columns() * cell_length_;
  double along = 0;
  for (int p = 0; p < grid_.size(); ++p) along += pressure_force_[p] / pressing_ * cell_middle(grid_.column(p));
  return along;
}

// Pressures act through the part's axis.
Vector3d Patch::place_of_force() const {
  return laid_at_ + middle_of_pressure() * (across_ + flank_.slope * normal_) + grid_.radius() * push_.normalized();
}

void Patch::lie_beside(const Patch& other) {
  OfCells dents;
  find_dents(other, dents);
  for (int p = 0; p < grid_.size(); ++p) cells_[p].dent += dents[p];
}

// G of a force that is spread over a cell, by a distance that is as long for the cell itself.
void Patch::find_dents(const Patch& other, OfCells& dents) {
  dents.fill(0);
  if (other.normal_.dot(normal_) <= 0) return;  // another side of the body
  const HalfSpace& half_space = grid_.half_space();
  const double scale = half_space.scale() * (1 - half_space.poisson) * other.force_.dot(normal_) / other.pressing_;
  const double self = half_space.scale() * (1 - half_space.poisson) / other.kernel_.own();
  list_laid();
  const int laid = static_cast<int>(rows_.size());
  PerCell x(laid), y(laid), z(laid), dent = PerCell::Zero(laid);
  for (int i = 0; i < laid; ++i) {
    const Vector3d& at = cells_[rows_[i]].at;
    x[i] = at.x(), y[i] = at.y(), z[i] = at.z();
  }
  for (int q = 0; q < other.grid_.size(); ++q) {
    if (!(other.pressure_force_[q] > 0)) continue;
    const Vector3d& at = other.cells_[q].at;
    dent += scale * other.pressure_force_[q] /
            ((x - at.x()).square() + (y - at.y()).square() + (z - at.z()).square() + self * self).sqrt();
  }
  for (int i = 0; i < laid; ++i) dents[rows_[i]] = dent[i];
}

void Patch::lie_in(const OfCells& dents) {
  for (int p = 0; p < grid_.size(); ++p) cells_[p].dent = dents[p];
}

// Of its force that a cell bears; before there is one, all of it is the deepest cell's.
void Patch::find_shares(OfCells& shares) const {
  shares.fill(0);
  const auto less_deep = [](const Cell& a, const Cell& b) { return a.gap < b.gap; };
  if (!touches()) shares[std::ranges::max_element(cells_, less_deep) - cells_.begin()] = 1;
  for (int p = 0; p < grid_.size() && touches(); ++p)
    if (laid(p)) shares[p] = pressure_force_[p] / pressing_;
}

double Patch::sunk(const OfCells& dents, std::span<const Vector3d> moved) const {
  OfCells shares;
  find_shares(shares);
  double sunk = 0;
  for (int p = 0; p < grid_.size(); ++p) {
    if (!(shares[p] > 0)) continue;
    const Foot& f = foot(p);
    sunk += shares[p] * dents[p];
    for (int v = 0; v < 3; ++v) sunk += shares[p] * f.weights[v] * direction_[grid_.foot(p)].dot(moved[f.local[v]]);
  }
  return sunk;
}

double Patch::softness() const {
  const int n = grid_.size();
  OfCells shares;
  find_shares(shares);
  std::array<Vector3d, kMaxNodes> of_nodes;
  of_nodes.fill(Vector3d::Zero());
  double soft = 0;
  for (int p = 0; p < n; ++p) {
    if (!(shares[p] > 0)) continue;
    for (int q = 0; q < n; ++q) soft += shares[p] * shares[q] * compliance_[p * n + q];
    for (int v = 0; v < 3; ++v)
      of_nodes[foot(p).local[v]] += foot(p).weights[v] * shares[p] * direction_[grid_.foot(p)];
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (std::size_t j = 0; !of_nodes[i].isZero(0) && j < nodes_.size(); ++j) {
      Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
      nodes_give_.add(static_cast<int>(i), static_cast<int>(j), 1, block);
      soft -= of_nodes[i].dot(block * of_nodes[j]);
    }
  return soft;
}

void Patch::sum_pressures() {
  pressing_ = 0;
  Vector3d sum = Vector3d::Zero();
  for (int p = 0; p < grid_.size(); ++p) {
    if (!(pressure_force_[p] > 0)) continue;
    pressing_ += pressure_force_[p];
    sum += pressure_force_[p] * direction_[grid_.foot(p)];
  }
  push_ = touches() ? Vector3d(sum / pressing_) : normal_;
}

void Patch::meet(const Ground& ground, std::span<const NodeGive> give) {
  fill_near_field(ground.near_field);
  fill_normal();
  keep_positive();
  add_nodes_give(give);
  std::ranges::fill(lift_, 0.0);
}

Vector3d Patch::direction(int foot) const {
  if (grid_.strip()) return normal_;
  const Eigen::Vector2d lean = leans_ * grid_.lean(foot);
  return normal_ + lean.x() * across_ + lean.y() * up_;
}

double Patch::rise(int foot, std::span<const Vector3d> moved) const {
  const Foot& f = feet_[foot];
  double rise = 0;
  for (int v = 0; v < 3; ++v) rise += f.weights[v] * direction_[foot].dot(moved[f.local[v]]);
  return rise;
}

// Of a sphere its middle; of a segment what lies over a place along the patch's first axis.
Vector3d Patch::on_axis(const Segment& axis, double along) const {
  if (!grid_.strip()) return axis.start;
  const Vector3d way = axis.end - axis.start;
  return axis.at((along - across_.dot(axis.start - laid_at_)) / across_.dot(way));
}

// Within a tick the cells stay where they are on the tissue; the part goes on.
double Patch::gap(int cell, const Step& step) const {
  const double along = grid_.strip() ? cell_middle(grid_.column(cell)) : 0;
  const double nearer = direction_[grid_.foot(cell)].dot(on_axis(step.axis, along) - laid_at_) - flank_.slope * along;
  return cells_[cell].gap + nearer - cells_[cell].dent - rise(grid_.foot(cell), step.moved) - lift_[cell];
}

std::span<double> Patch::sink(const Ground& ground, const Step& step) {
  lift_cells(ground, step.give);
  bound_lift();
  for (int p = 0; p < grid_.size(); ++p) {
    if (!laid(p)) active_[p] = 0;
    wanted_[p] = laid(p) ? gap(p, step) : cells_[p].gap;
  }
  return wanted_;
}

void Patch::step(const Ground& ground, const Step& step) {
  settle_pressures();
  sum_pressures();
  at_ = on_axis(step.axis, middle_of_pressure()) + grid_.radius() * push_.normalized();
  shear(ground, {at_ - step.before * (step.now.inverse() * at_), step.went, step.give});
}

void Patch::remember(std::span<const Vector3d> moved) {
  if (!memory_) return;
  const int n = grid_.size();
  const double elastic = 1 / memory_->instant();
  for (int p = 0; p < n; ++p) {
    const Foot& f = foot(p);
    wanted_[p] = 0;
    if (!laid(p)) continue;
    for (const int q : rows_) wanted_[p] += elastic * compliance_[p * n + q] * pressure_force_[q];
    for (int v = 0; v < 3; ++v) wanted_[p] -= elastic * f.weights[v] * direction_[grid_.foot(p)].dot(moved[f.local[v]]);
  }
  memory_->follow(wanted_, elastic * sheared_);
  memory_->slip(slip_, grid_.edge() * std::sqrt(static_cast<double>(rows_.size())));
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
      if (!laid(p)) continue;
      if (active_[p]) {
        if (pressure_force_[p] < -1e-12 * largest) active_[p] = 0, changed = true;
        continue;
      }
      double moved = 0;
      for (const int q : rows_) moved += compliance_[p * n + q] * pressure_force_[q];
      if (moved < wanted_[p] - kTouchTolerance) active_[p] = 1, changed = true;
    }
  }
  settled_ = !changed;
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
    floor_[c] = kPivotShare * kernel_.own();
    right_[c] = wanted_[rows_[c]];
  }
  kernels::active().cholesky(factor_.data(), m, ld, floor_.data());
  kernels::active().cholesky_solve(factor_.data(), m, ld, right_.data());
  for (int c = 0; c < m; ++c) pressure_force_[rows_[c]] = right_[c];
  return std::isfinite(right_[0]);
}

Eigen::Matrix3d Patch::give() const {
  if (!touches()) return Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> plane;
  plane << across_, up_;
  return softness() * normal_ * normal_.transpose() + plane * sheared_give_ * plane.transpose();
}

bool Patch::fits(int nodes) const {
  const auto known = [&](int node) { return node >= 0 && node < nodes; };
  return loaded_ >= 0 && loaded_ <= max_nodes_ && std::ranges::all_of(anchor_.nodes, known) &&
         std::ranges::all_of(forces(), known, &PatchForce::node);
}

void Patch::state(State& s) {
  s.all(active_);
  s.value(bent_);
  s.value(resumed_);
  s.value(force_);
  s.value(pressing_);
  s.value(push_);
  s.value(shear_);
  s.all(pressure_force_);
  for (Cell& cell : cells_) s.value(cell.at);
  s.value(cell_length_);
  s.value(depth_);
  s.value(normal_);
  s.value(at_);
  palpate::state(s, anchor_);
  s.value(sticks_);
  if (memory_) memory_->state(s);
  for (PatchForce& f : forces_) {
    s.value(f.node);
    s.value(f.force);
  }
  s.value(loaded_);
  if (s.restoring() && cell_length_ > 0) kernel_.lay(cell_length_);
}

}  // namespace palpate
