#include "common/models/catheter/catheter_body.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/geometry/segment.hpp"

namespace palpate {
namespace {

using Eigen::Vector3d;

constexpr int kMaxSubsteps = 64;
constexpr double kStepMargin = 1.5;  ///< step times frequency bound; eq. 28 is stable up to 2
constexpr double kMaxStride = 0.5;  ///< of the spacing: by how much neighbours may move against each other in a substep
constexpr int kMaxRounds = 4;       ///< of passages through the wall found and closed

int substeps_for(const Catheter& shape, double step, double bound) {
  if (shape.integrator == ChainIntegrator::implicit) return 1;
  const double needed = std::ceil(step * bound / kStepMargin);
  if (needed <= kMaxSubsteps) return std::max(1, static_cast<int>(needed));
  throw std::runtime_error(
      fmt::format("the catheter is too stiff for semi_implicit: it would need {:.0f} substeps a tick and {} "
                  "are the most; use implicit",
                  needed, kMaxSubsteps));
}

}  // namespace

CatheterBody::CatheterBody(const CatheterSettings& settings, const DuctWall* wall)
    : chain_(settings.shape, settings.young, settings.density),
      radius_(settings.shape.radius),
      step_(settings.step),
      damping_(settings.shape.damping),
      gravity_(settings.shape.gravity),
      implicit_(settings.shape.integrator == ChainIntegrator::implicit),
      substeps_(substeps_for(settings.shape, settings.step, chain_.frequency_bound())),
      wall_(wall),
      lumen_(wall, chain_.rest(), settings.shape.radius),
      sleeve_(settings.shape.tail, settings.shape.tip, settings.shape.sleeve),
      grasps_(settings.max_tools),
      wall_touches_(chain_.size(), wall, settings.shape.radius, settings.friction),
      tool_touches_(chain_.size() - 1, settings.max_parts),
      solve_(chain_.size(), wall, max_touches(chain_.size(), settings.max_parts)),
      x_(chain_.rest().begin(), chain_.rest().end()),
      v_(chain_.size(), Vector3d::Zero()),
      before_(x_),
      force_(chain_.size()),
      tension_(chain_.size() - 1, 0.0),
      base_(chain_.size()),
      right_side_(3 * chain_.size()) {
  if (!(step_ > 0)) throw std::runtime_error("the catheter's step must be positive");
  wall_forces_.reserve(2 * chain_.size());
  tool_forces_.reserve(max_touches(chain_.size(), settings.max_parts) + Grasps::kMaxPoints * settings.max_tools);
}

int CatheterBody::max_touches(int particles, int parts) {
  return (2 + kMaxRounds) * particles + parts * std::min(particles, 64);
}

void CatheterBody::step(std::span<const CatheterTool> tools, std::span<const Eigen::Isometry3d> jaws) {
  lumen_.follow_mouths(x_);
  solve_.begin();
  wall_touches_.find(x_, v_, step_, lumen_, solve_);
  tool_touches_.find(tools, x_, radius_, grasps_, solve_);
  grasps_.begin(jaws);
  before_ = x_;
  for (int i = 0; i < substeps_; ++i) substep(i);
  lumen_.follow_particles(before_, x_);
  lumen_.follow_chain(x_);
  lumen_.release_lost(x_);
  solve_.end();
  grasps_.end();
  wall_touches_.keep(solve_.touches());
  tool_touches_.keep(solve_.touches());
  collect_forces(tools);
}

void CatheterBody::substep(int index) {
  const double h = step_ / substeps_, left = static_cast<double>(substeps_ - 1 - index) / substeps_;
  assemble(h, left);
  for (int round = 0;; ++round) {
    solve_.solve(base_, right_side_, v_, h, index, substeps_);
    const bool tauter = note_tension(h) && round == 0;
    if (tauter) assemble(h, left);
    const bool closed = round < kMaxRounds && close_passages();
    if (!closed && !tauter) break;
  }
  keep_together();
  hold_back();
  const auto motion = solve_.motion();
  for (int i = 0; i < size(); ++i) {
    x_[i] += motion[i];
    v_[i] = motion[i] / h;
  }
  solve_.advance();
  grasps_.add_forces(x_, left, 1.0 / substeps_);
}

void CatheterBody::assemble(double h, double left) {
  base_.set_zero();
  for (int i = 0; i < size(); ++i) force_[i] = chain_.mass()[i] * (gravity_ + v_[i] / h);
  chain_.add_forces(x_, force_);
  if (implicit_) chain_.add_stiffness(x_, tension_, base_);
  for (int i = 0; i < size(); ++i) {
    base_.add(i, 0, chain_.mass()[i] * (1 / h + damping_) / h * Eigen::Matrix3d::Identity());
    Eigen::Map<Vector3d>(right_side_.data() + 3 * i) = force_[i];
  }
  sleeve_.add_springs(x_, base_, right_side_);
  grasps_.add_springs(x_, left, base_, right_side_);
}

/// Takes down the segments' tension after the motion. True where it has grown so much that the string's
/// stiffness across, which was taken from the tension before, would have let particles swing too far.
bool CatheterBody::note_tension(double h) {
  if (!implicit_) return false;
  bool grown = false;
  for (int i = 0; i + 1 < size(); ++i) {
    const double now = chain_.tension(i, x_, solve_.motion());
    grown |= now - std::max(0.0, tension_[i]) > spacing() * chain_.mass()[1] / (h * h);
    tension_[i] = now;
  }
  return grown;
}

/// Adds touches where particles would pass through the wall. True if the substep is to be solved again.
bool CatheterBody::close_passages() {
  if (!wall_) return false;
  solve_.show(wall_touches_.wall_motion());
  bool found = false;
  for (int i = 0; i < size(); ++i) {
    const auto passage = wall_touches_.passage(i, x_[i], solve_.motion()[i], lumen_);
    if (!passage) continue;
    solve_.add(passage->touch);
    found = true;
  }
  return found;
}

/// Particles that would pass through the wall all the same go no farther than the wall does.
void CatheterBody::hold_back() {
  if (!wall_) return;
  solve_.show(wall_touches_.wall_motion());
  for (int i = 0; i < size(); ++i) {
    const auto passage = wall_touches_.passage(i, x_[i], solve_.motion()[i], lumen_);
    if (!passage) continue;
    solve_.motion()[i] = passage->before - x_[i];
    solve_.effort().limited++;
  }
}

/// Linear springs know nothing of turning: where neighbours would move by more than half their spacing
/// against each other in one go, all motion is shortened. It takes energy out and adds none.
void CatheterBody::keep_together() {
  const auto motion = solve_.motion();
  double widest = 0;
  for (int i = 0; i + 1 < size(); ++i) widest = std::max(widest, (motion[i + 1] - motion[i]).squaredNorm());
  const double most = kMaxStride * spacing();
  if (widest <= most * most) return;
  for (Vector3d& d : motion) d *= most / std::sqrt(widest);
  solve_.effort().limited++;
}

void CatheterBody::collect_forces(std::span<const CatheterTool> tools) {
  wall_forces_.clear();
  tool_forces_.clear();
  for (const CatheterTouch& t : solve_.touches()) {
    if (t.force == Vector3d::Zero()) continue;
    if (t.on_wall)
      wall_forces_.push_back({t.anchor, -t.force});
    else
      tool_forces_.push_back({tools[t.part].tool, tools[t.part].part, t.at, t.force});
  }
  for (int tool = 0; tool < grasps_.tools(); ++tool)
    for (int i = 0; i < grasps_.of(tool).count; ++i) {
      const Grasps::Held& held = grasps_.of(tool).held[i];
      tool_forces_.push_back({tool, -1, held.target, held.force});
    }
}

ChainPoint CatheterBody::nearest(const Vector3d& p) const {
  ChainPoint best;
  double least = -1;
  for (int i = 0; i + 1 < size(); ++i) {
    const double along = nearest_share({x_[i], x_[i + 1]}, p), away = (place({i, along}) - p).squaredNorm();
    if (least >= 0 && away >= least) continue;
    least = away;
    best = {i, along};
  }
  return best;
}

Vector3d CatheterBody::place(const ChainPoint& point) const {
  return place_of(point, x_);
}

int CatheterBody::points_near(const Vector3d& centre, double radius, std::span<Vector3d> found) const {
  int count = 0;
  for (const Vector3d& p : x_)
    if ((p - centre).squaredNorm() <= radius * radius && count < static_cast<int>(found.size())) found[count++] = p;
  return count;
}

void CatheterBody::grasp(int tool, const Eigen::Isometry3d& jaw, const ChainPoint& point, double length,
                         double compliance) {
  grasps_.take(tool, 1 / compliance);
  const double half = 0.5 * length / spacing(), middle = point.segment + point.along, last = size() - 1;
  for (const double at : {middle - half, middle, middle + half}) {
    if (at < 0 || at > last || (half == 0 && grasps_.holds(tool))) continue;
    const int segment = std::min(static_cast<int>(at), size() - 2);
    grasps_.add(tool, {segment, at - segment}, place({segment, at - segment}), jaw);
  }
}

double CatheterBody::inserted() const {
  return lumen_.inserted(x_, spacing());
}

double CatheterBody::energy() const {
  double energy = chain_.elastic_energy(x_);
  for (int i = 0; i < size(); ++i)
    energy += chain_.mass()[i] * (0.5 * v_[i].squaredNorm() - gravity_.dot(x_[i] - chain_.rest()[i]));
  return energy;
}

}  // namespace palpate
