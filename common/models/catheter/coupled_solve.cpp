#include "common/models/catheter/coupled_solve.hpp"

#include <algorithm>
#include <cmath>

#include "common/models/catheter/grasps.hpp"

namespace palpate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kLanes = 4;  // rows are padded to as many
using Lanes = Eigen::Array<double, kLanes, 1>;

/// Three rows times a vector.
Vector3d product(const double* rows, const double* y, int count) {
  Lanes sum[3] = {Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};
  for (int m = 0; m < count; m += kLanes) {
    const Lanes factor = Eigen::Map<const Lanes>(y + m);
    for (int axis = 0; axis < 3; ++axis) sum[axis] += Eigen::Map<const Lanes>(rows + axis * count + m) * factor;
  }
  return {sum[0].sum(), sum[1].sum(), sum[2].sum()};
}

Matrix3d across(const Vector3d& normal) {
  return Matrix3d::Identity() - normal * normal.transpose();
}

}  // namespace

CoupledSolve::CoupledSolve(int particles, const DuctWall* wall, int max_touches)
    : particles_(particles),
      modes_(wall ? static_cast<int>(wall->inverse().size()) : 0),
      stride_((modes_ + kLanes - 1) / kLanes * kLanes),
      max_touches_(max_touches),
      duct_(wall),
      rows_(static_cast<std::size_t>(max_touches) * 3 * stride_, 0.0),
      unpadded_(3 * modes_),
      stiffness_(max_touches),
      first_(max_touches),
      given_(max_touches),
      push_(max_touches),
      wall_(max_touches),
      wall_change_(max_touches, Vector3d::Zero()),
      factor_(particles),
      d_(3 * particles + BandMatrix::kBand),
      change_(d_.size()) {
  touches_.reserve(max_touches);
  for (auto* values : {&y_, &free_, &inverse_, &answer_, &gone_, &residual_, &direction_, &image_})
    values->assign(stride_, 0.0);
}

void CoupledSolve::begin() {
  touches_.clear();
  effort_ = {};
  if (modes_ == 0) return;
  std::ranges::fill(gone_, 0.0);
  std::copy_n(duct_->free_motion().data(), modes_, free_.data());
  for (int m = 0; m < modes_; ++m) y_[m] = free_[m] + answer_[m];
}

void CoupledSolve::add(const CatheterTouch& touch) {
  const int i = static_cast<int>(touches_.size());
  if (i == max_touches_) return;
  touches_.push_back(touch);
  stiffness_[i] = 1 / touch.compliance;
  if (!touch.on_wall) return;
  stiffness_[i] =
      1 / (touch.compliance + std::max(0.0, touch.normal.dot(duct_->residual(touch.anchor) * touch.normal)));
  if (modes_ == 0) return;
  duct_->rows(touch.anchor, unpadded_.data());
  double* to = rows(i);
  for (int axis = 0; axis < 3; ++axis) std::copy_n(unpadded_.data() + axis * modes_, modes_, to + axis * stride_);
}

Vector3d CoupledSolve::point_motion(const CatheterTouch& touch, const double* d) const {
  const double* a = d + 3 * touch.point.segment;
  const double b = touch.point.along;
  return {(1 - b) * a[0] + b * a[3], (1 - b) * a[1] + b * a[4], (1 - b) * a[2] + b * a[5]};
}

Vector3d CoupledSolve::wall_motion(int touch, const double* y) const {
  if (modes_ == 0 || !touches_[touch].on_wall) return Vector3d::Zero();
  return product(rows(touch), y, stride_);
}

void CoupledSolve::add_wall_force(int touch, const Vector3d& force, double* modal) const {
  const double* row = rows(touch);
  for (int m = 0; m < stride_; m += kLanes)
    Eigen::Map<Lanes>(modal + m) += force[0] * Eigen::Map<const Lanes>(row + m) +
                                    force[1] * Eigen::Map<const Lanes>(row + stride_ + m) +
                                    force[2] * Eigen::Map<const Lanes>(row + 2 * stride_ + m);
}

double CoupledSolve::left_overlap(int touch) const {
  const CatheterTouch& t = touches_[touch];
  return first_[touch] - t.normal.dot(point_motion(t, d_.data()) - wall_[touch]);
}

/// The force on the catheter by the touch as the solution takes it: also pulling, where the last pass has
/// left it so.
Vector3d CoupledSolve::spring_force(int touch) const {
  const CatheterTouch& t = touches_[touch];
  const Vector3d slip = point_motion(t, d_.data()) - wall_[touch];
  return stiffness_[touch] * (first_[touch] - t.normal.dot(slip)) * t.normal -
         t.sticking * across(t.normal) * (slip - now_.share * t.carried);
}

void CoupledSolve::solve(const BandMatrix& base, std::span<const double> right_side, std::span<const Vector3d> velocity,
                         double h, int index, int of) {
  now_ = {h, 1.0 / of, static_cast<double>(of - 1 - index) / of};
  for (int m = 0; m < modes_; ++m) {
    inverse_[m] = duct_->inverse()[m] * now_.share * now_.share;
    y_[m] *= now_.share;
    free_[m] *= now_.share;
  }
  first_guess(velocity);
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    ++effort_.passes;
    if (!eliminate(base, right_side)) break;
    if (modes_ > 0) solve_modes();
    if (pass + 1 == kMaxPasses || !revise(pass)) break;
  }
  settle();
  for (int m = 0; m < modes_; ++m) {
    y_[m] /= now_.share;
    free_[m] /= now_.share;
  }
}

void CoupledSolve::settle() {
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const CatheterTouch& t = touches_[i];
    given_[i] = t.normal.dot(wall_[i]);
    push_[i].setZero();
    if (t.active) push_[i] = spring_force(i);
  }
}

void CoupledSolve::first_guess(std::span<const Vector3d> velocity) {
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    CatheterTouch& t = touches_[i];
    first_[i] = t.overlap - now_.left * t.normal.dot(t.carried);
    wall_[i] = wall_motion(i, y_.data());
    const Vector3d slip = now_.h * place_of(t.point, velocity) - wall_[i];
    const bool met = now_.left == 1 - now_.share ? t.grip > 0 || t.normal_force > 0 : t.active;
    t.active = first_[i] - t.normal.dot(slip) > 0 || (met && first_[i] > 0);
    const double sliding = (across(t.normal) * (slip - now_.share * t.carried)).norm();
    t.sticking = t.grip / std::max(sliding, kCreep * now_.h);
  }
}

/// Factors the catheter's matrix with the springs of the active touches in it and finds its motion for the
/// wall's y.
bool CoupledSolve::eliminate(const BandMatrix& base, std::span<const double> right_side) {
  factor_.copy(base);
  std::copy(right_side.begin(), right_side.begin() + 3 * particles_, d_.begin());
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const CatheterTouch& t = touches_[i];
    if (!t.active) continue;
    const Matrix3d normal = t.normal * t.normal.transpose();
    const Matrix3d spring = stiffness_[i] * normal + t.sticking * (Matrix3d::Identity() - normal);
    const Vector3d pull = stiffness_[i] * first_[i] * t.normal +
                          t.sticking * across(t.normal) * (now_.share * t.carried) + spring * wall_[i];
    add_at_point(t.point, spring, factor_);
    add_at_point(t.point, pull, std::span(d_));
  }
  if (!factor_.factorise()) {
    std::fill(d_.begin(), d_.end(), 0.0);
    ++effort_.limited;
    return false;
  }
  factor_.solve(d_);
  return true;
}

/// Change of the catheter's motion, and force of the touches' springs on the modes, for a change y of the
/// modes.
void CoupledSolve::response(const double* y, double* d, double* modal) {
  std::fill_n(d, 3 * particles_, 0.0);
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const CatheterTouch& t = touches_[i];
    if (!t.active || !t.on_wall) continue;
    const Vector3d w = wall_change_[i] = wall_motion(i, y), n = t.normal;
    const Vector3d force = t.sticking * w + (stiffness_[i] - t.sticking) * n.dot(w) * n;
    add_at_point(t.point, force, std::span(d, 3 * particles_));
  }
  factor_.solve(std::span(d, d_.size()));
  std::fill_n(modal, stride_, 0.0);
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const CatheterTouch& t = touches_[i];
    if (!t.active || !t.on_wall) continue;
    const Vector3d slip = point_motion(t, d) - wall_change_[i], n = t.normal;
    add_wall_force(i, t.sticking * slip + (stiffness_[i] - t.sticking) * n.dot(slip) * n, modal);
  }
}

/// Conjugate gradients over the modes, from the y and the d that stand.
void CoupledSolve::solve_modes() {
  std::fill(image_.begin(), image_.end(), 0.0);
  bool any = false;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    if (!touches_[i].active || !touches_[i].on_wall) continue;
    add_wall_force(i, -spring_force(i), image_.data());
    any = true;
  }
  if (!any) y_ = free_;
  double squared = 0, push = 0;
  for (int m = 0; m < modes_; ++m) {
    residual_[m] = (free_[m] - y_[m]) + inverse_[m] * image_[m];  // times inverse already: the preconditioned one
    direction_[m] = residual_[m];
    squared += residual_[m] * residual_[m] / inverse_[m];
    push += image_[m] * image_[m] * inverse_[m];
  }
  const double enough = kTolerance * kTolerance * push;
  for (int i = 0; any && i < kMaxIterations && squared > enough; ++i) {
    ++effort_.iterations;
    response(direction_.data(), change_.data(), image_.data());
    double curvature = 0;
    for (int m = 0; m < modes_; ++m) {
      image_[m] = direction_[m] - inverse_[m] * image_[m];
      curvature += direction_[m] * image_[m] / inverse_[m];
    }
    const double step = squared / curvature;
    double next = 0;
    for (int m = 0; m < modes_; ++m) {
      y_[m] += step * direction_[m];
      residual_[m] -= step * image_[m];
      next += residual_[m] * residual_[m] / inverse_[m];
    }
    for (int k = 0; k < 3 * particles_; ++k) d_[k] += step * change_[k];
    for (std::size_t k = 0; k < touches_.size(); ++k)
      if (touches_[k].active) wall_[k] += step * wall_change_[k];
    for (int m = 0; m < modes_; ++m) direction_[m] = residual_[m] + next / squared * direction_[m];
    squared = next;
  }
  for (std::size_t i = 0; i < touches_.size(); ++i)
    if (!touches_[i].active && touches_[i].on_wall) wall_[i] = wall_motion(i, y_.data());
}

/// Sets which touches push, gives those newly met their friction, and weakens friction that has come out
/// above its limit. True if another pass is due.
bool CoupledSolve::revise(int pass) {
  bool again = false;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    CatheterTouch& t = touches_[i];
    const double overlap = left_overlap(i);
    const bool wanted = overlap > 0 || (t.active && pass >= kFreePasses);
    if (wanted != t.active) {
      t.active = wanted;
      again = true;
    }
    if (!t.active || t.friction == 0 || pass >= kFrictionPasses) continue;
    const double limit = t.friction * stiffness_[i] * std::max(0.0, overlap);
    const bool fresh = t.grip == 0;
    t.grip = fresh ? limit : std::min(t.grip, limit);
    const Vector3d slip = point_motion(t, d_.data()) - wall_[i] - now_.share * t.carried;
    const double sliding = std::max((across(t.normal) * slip).norm(), kCreep * now_.h);
    if (!fresh && t.sticking * sliding < 1.2 * t.grip) continue;
    t.sticking = t.grip / sliding;
    again = true;
  }
  return again;
}

std::span<const Vector3d> CoupledSolve::motion() const {
  return {reinterpret_cast<const Vector3d*>(d_.data()), static_cast<std::size_t>(particles_)};
}

std::span<Vector3d> CoupledSolve::motion() {
  return {reinterpret_cast<Vector3d*>(d_.data()), static_cast<std::size_t>(particles_)};
}

void CoupledSolve::show(WallMotion& wall) {
  for (int m = 0; m < modes_; ++m) residual_[m] = gone_[m] + now_.share * y_[m];
  wall.set(std::span(gone_).first(modes_), std::span(residual_).first(modes_));
}

void CoupledSolve::advance() {
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    CatheterTouch& t = touches_[i];
    t.overlap -= t.normal.dot(point_motion(t, d_.data())) - given_[i];
    t.force += now_.share * push_[i];
    t.normal_force += now_.share * push_[i].dot(t.normal);
  }
  for (int m = 0; m < modes_; ++m) {
    const double answer = y_[m] - free_[m];
    gone_[m] += now_.share * y_[m];
    free_[m] = y_[m];
    y_[m] += answer;
  }
}

void CoupledSolve::end() {
  effort_.touches = static_cast<int>(touches_.size());
  for (int m = 0; m < modes_; ++m) answer_[m] = (free_[m] - duct_->free_motion()[m]) * now_.share;
}

}  // namespace palpate
