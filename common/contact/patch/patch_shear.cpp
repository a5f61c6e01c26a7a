// What a patch does to the tissue across its normal, and what that does along it.
#include <algorithm>
#include <cmath>

#include "common/contact/patch/patch.hpp"

namespace palpate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMaxLift = 0.15;  // within a face it is 0.12 at most; with 0.25 a rough tip buzzes at a rim

}  // namespace

// What the last step's shear does along the normal: the nodes, by K and by what they give way, and the half-space.
void Patch::lift_cells(const Ground& ground, std::span<const NodeGive> give) {
  std::ranges::fill(lift_, 0.0);
  if (ground.friction == 0 || !touches()) return;
  lift_nodes(give);
  const Vector2d shear(across_.dot(shear_) / pressing_, up_.dot(shear_) / pressing_);
  kernel_.lay_crossed();
  for (int p = 0; p < grid_.size(); ++p) {
    if (!laid(p)) continue;
    lift_[p] = lift_at(foot(p));
    for (int q = 0; q < grid_.size(); ++q)
      if (pressure_force_[q] > 0) lift_[p] += pressure_force_[q] * kernel_.crossed(p, q).dot(shear);
  }
}

void Patch::lift_nodes(std::span<const NodeGive> give) {
  lifted_.assign(nodes_.size(), 0.0);
  std::array<Vector3d, kMaxNodes> shear;
  shear.fill(Vector3d::Zero());
  for (const PatchForce& f : forces()) {
    const auto found = std::ranges::find(nodes_, f.node);
    if (found == nodes_.end()) continue;
    const auto j = found - nodes_.begin();
    shear[j] = f.force.dot(normal_) / pressing_ * shear_;
    near_field_.along(normal_, shear[j], place_[j], static_cast<int>(known_.size()), at_places_.data());
    for (std::size_t i = 0; i < nodes_.size(); ++i) lifted_[i] += at_places_[place_[i]];
  }
  for (const auto& [i, j, block] : give) {
    lifted_[i] += normal_.dot(block * shear[j]);
    if (i != j) lifted_[j] += normal_.dot(block.transpose() * shear[i]);
  }
}

// Near a rim, and under a wide strip, elements that move may say that a shear lifts the tissue by more than the same
// force presses it in. Pressures see the shear, the shear does not see them: such a contact would put out work. What is
// lifted, in the mean over the pressures, is held to a share of what the same force gives way by along the normal.
void Patch::bound_lift() {
  const double shear = shear_.norm();
  if (!(pressing_ > 0) || shear == 0) return;
  std::array<int, kMaxCells> pressed;
  int count = 0;
  for (int p = 0; p < grid_.size(); ++p)
    if (laid(p) && pressure_force_[p] > 0) pressed[count++] = p;
  double give = 0, squares = 0;  // [m N], [N m^2]
  for (const int p : std::span(pressed).first(count)) {
    const double f = pressure_force_[p];
    squares += f * std::pow(lift_[p], 2);
    for (const int q : std::span(pressed).first(count))
      give += f * pressure_force_[q] * compliance_[p * grid_.size() + q];
  }
  const double lift = std::sqrt(squares / pressing_), most = kMaxLift * give * shear / (pressing_ * pressing_);
  if (lift <= most) return;
  for (double& l : lift_) l *= most / lift;
}

double Patch::lift_at(const Foot& f) const {
  double lift = 0;
  for (int v = 0; v < 3; ++v) lift += f.weights[v] * lifted_[f.local[v]];
  return lift;
}

// One shear force, spread as the pressures are. The tissue is bent along until Coulomb's bound is met; from there it
// slips and stays bent as far as the bound allows, so that the shear never turns against the travel. Nodes that move by
// themselves take a part of the travel, which is not bent any more at the next step.
void Patch::shear(const Ground& ground, const Drag& drag) {
  loaded_ = 0;
  sheared_.setZero();
  if (pressing_ <= 0) {
    bent_.setZero();
    resumed_.setZero();
    force_.setZero();
    shear_.setZero();
    return;
  }
  const int n = grid_.size(), count = static_cast<int>(nodes_.size());
  std::array<double, kMaxNodes> share{};
  std::array<Vector3d, kMaxNodes> pressed;  // [N] by pressures
  pressed.fill(Vector3d::Zero());
  for (int p = 0; p < n; ++p)
    for (int v = 0; v < 3 && pressure_force_[p] > 0; ++v) {
      const double force = foot(p).weights[v] * pressure_force_[p];
      share[foot(p).local[v]] += force / pressing_;
      pressed[foot(p).local[v]] += force * direction_[grid_.foot(p)];
    }
  shear_.setZero();
  if (ground.friction > 0) {
    Eigen::Matrix<double, 3, 2> plane;
    plane << across_, up_;
    const Eigen::Matrix2d c = compliance_to_shear(plane, std::span(share).first(count));
    Eigen::Matrix2d given = Eigen::Matrix2d::Zero();
    const Vector3d past = memory_ ? memory_->bent() : Vector3d::Zero();
    Vector2d bent = plane.transpose() * (bent_ + drag.travel - past);
    if (!resumed_.isZero(0)) bent = c * plane.transpose() * resumed_;
    resumed_.setZero();
    for (std::size_t i = 0; i < drag.went.size(); ++i) bent -= share[i] * plane.transpose() * drag.went[i];
    for (const auto& [i, j, block] : drag.give) {
      if (share[i] == 0 || share[j] == 0) continue;
      const Eigen::Matrix3d both = i == j ? block : Eigen::Matrix3d(block + block.transpose());
      given += share[i] * share[j] * plane.transpose() * both * plane;
      bent -= share[i] * plane.transpose() * block * pressed[j];
      if (i != j) bent -= share[j] * plane.transpose() * block.transpose() * pressed[i];
    }
    Vector2d force = (c + given).inverse() * bent;
    const double most = ground.friction * pressing_, size = force.norm();
    sticks_ = size <= most;
    if (!sticks_) force *= most / size;
    if (!sticks_ || !drag.give.empty()) bent = c * force;
    sheared_ = bent_ = plane * bent;
    sheared_give_ = c;
    if (memory_) bent_ += past - past.dot(normal_) * normal_;
    shear_ = plane * force;
  }
  force_ = pressure() + shear_;
  for (int i = 0; i < count; ++i)
    if (share[i] != 0) forces_[loaded_++] = {nodes_[i], pressed[i] + share[i] * shear_};
}

// What of its way the tip has not taken the tissue along.
void Patch::add_slip(const Vector3d& bent_before) {
  const Vector3d slip = travel_ - (bent_ - bent_before);
  slip_ = {across_.dot(slip), up_.dot(slip)};
}

}  // namespace palpate
