#include "tools/motion/motion_maker.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/tool/instrument.hpp"
#include "tools/motion/tip_path.hpp"

namespace palpate {
namespace {

constexpr double kAlong = 0.002;  // [m] from place to place of a slide
constexpr double kDeepest = 4;    // radii to which a force is looked for
constexpr double kJaws = 0.3;     // [s] to open or shut
constexpr double kSettles = 1;    // [s] in which a force comes to stand
constexpr double kMet = 0.01;     // of a force, by which it may be missed
constexpr int kTries = 8;         // of a depth

double diagonal_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  return box.diagonal().norm();
}

std::optional<double> widest_jaws_of(const Tool& tool) {
  const auto jaws = abilities_of(tool).turning;
  return jaws ? std::optional(jaws->max_open) : std::nullopt;
}

}  // namespace

MotionMaker::MotionMaker(const Tool& tool, const SurfaceMap& map, const Rehearsal& rehearsal,
                         const MotionManner& manner)
    : surface_(map),
      rehearsal_(rehearsal),
      manner_(manner),
      trocar_(make_trocar(tool.pivot, tool.axis, tool.up)),
      reach_(reach_of(tool)),
      radius_(abilities_of(tool).radius),
      deepest_press_(diagonal_of(map.position)),
      has_jaws_(abilities_of(tool).turning || abilities_of(tool).closing),
      widest_jaws_(widest_jaws_of(tool)) {
  for (std::size_t t = 0; t < map.triangles.size(); ++t)
    if (std::ranges::all_of(map.triangles[t], [&](int n) { return n < map.touchable; }))
      triangles_.push_back(static_cast<int>(t));
  if (triangles_.empty()) throw std::runtime_error("no part of its surface can be touched");
}

SurfacePlace MotionMaker::place_near(const Eigen::Vector3d& point) const {
  return nearest_place(surface_, point, triangles_);
}

void MotionMaker::go_to(const Eigen::Vector3d& point) {
  place_ = place_near(point);
  depth_ = -manner_.clear;
  const Eigen::Vector3d tip = tip_at(*place_, depth_);
  if (!rows_) return void(rows_.emplace(trocar_, reach_, tip));
  rows_->go({tip}, manner_.speed);
}

void MotionMaker::press(double depth) {
  depth_ = depth;
  rows_->go({tip_at(*place_, depth)}, manner_.speed);
}

// The tip's way is the surface's, at the depth that it has.
void MotionMaker::slide(const Eigen::Vector3d& point) {
  const SurfacePlace end = place_near(point);
  const Eigen::Vector3d begin = place_->point;
  const int steps = std::max(1, static_cast<int>(std::ceil((end.point - begin).norm() / kAlong)));
  std::vector<Eigen::Vector3d> way;
  for (int i = 1; i <= steps; ++i) {
    place_ = i == steps ? end : place_near(begin + static_cast<double>(i) / steps * (end.point - begin));
    way.push_back(tip_at(*place_, depth_));
  }
  rows_->go(way, manner_.speed);
}

MotionMaker::Pass MotionMaker::pass_to(double depth) const {
  MotionRows trial = *rows_;
  trial.go({tip_at(*place_, depth)}, manner_.speed);
  const Trajectory motion = trial.trajectory();
  const std::vector<double> felt = rehearsal_.forces(motion);
  const auto first = std::min(static_cast<std::size_t>(rows_->time() / rehearsal_.dt()), felt.size() - 1);
  const Eigen::Vector3d touching = tip_at(*place_, 0);
  Pass pass;
  for (std::size_t i = first; i < felt.size(); ++i) {
    const ToolDofs dofs = motion.at(static_cast<double>(i) * rehearsal_.dt());
    const Eigen::Vector3d tip = tip_pose(trocar_, dofs) * (reach_ * Eigen::Vector3d::UnitZ());
    pass.depth.push_back((tip - touching).dot(place_->inward));
    pass.force.push_back(felt[i]);
  }
  return pass;
}

MotionMaker::Press MotionMaker::press_at(double depth) const {
  MotionRows trial = *rows_;
  trial.go({tip_at(*place_, depth)}, manner_.speed);
  const auto arrives = static_cast<std::size_t>(trial.time() / rehearsal_.dt());
  trial.stand(kSettles);
  const std::vector<double> felt = rehearsal_.forces(trial.trajectory());
  return {felt[std::min(arrives, felt.size() - 1)], felt.back()};
}

// Pressed on and on, as slowly as the rest is done, until the force is there; where more is felt already, let go.
MotionMaker::Guess MotionMaker::guess_for(double force) const {
  Pass pass = pass_to(kDeepest * radius_);
  const bool back = pass.force.front() > force;
  if (back) pass = pass_to(-manner_.clear);
  const auto met = std::ranges::find_if(pass.force, [&](double f) { return back ? f <= force : f >= force; });
  if (met == pass.force.end() && back)
    throw std::runtime_error(
        fmt::format("there the force is at least {:.3g} N, clear of the surface too", std::ranges::min(pass.force)));
  if (met == pass.force.end())
    throw std::runtime_error(fmt::format("there the force is at most {:.3g} N, {:.0f} mm deep",
                                         std::ranges::max(pass.force), 1e3 * kDeepest * radius_));
  const double depth = pass.depth[met - pass.force.begin()];
  double touches = depth;  // the shallowest depth with a force
  for (std::size_t i = 0; i < pass.force.size(); ++i)
    if (pass.force[i] > 0) touches = std::min(touches, pass.depth[i]);
  return {depth, force / std::max(depth - touches, 1e-3 * radius_)};
}

// On its way the tool also feels the tissue's inertia and damping, and the force changes until both are at rest. So
// depths are tried until the force that stands is the one asked for: along the last two, or halfway between the
// nearest ones with less and with more.
void MotionMaker::press_with(double force) {
  auto [depth, slope] = guess_for(force);
  double shallow = -manner_.clear, deep = std::max(kDeepest * radius_, depth_), best = depth;
  Press felt = press_at(depth), best_felt = felt;
  for (int tries = 1; tries < kTries && std::abs(best_felt.standing - force) > kMet * force; ++tries) {
    (felt.standing < force ? shallow : deep) = depth;
    const double along = depth + (force - felt.standing) / slope;
    const double next = along > shallow && along < deep ? along : (shallow + deep) / 2;
    const Press now = press_at(next);
    const double steeper = (now.standing - felt.standing) / (next - depth);
    if (steeper > 0) slope = steeper;
    depth = next;
    felt = now;
    if (std::abs(felt.standing - force) >= std::abs(best_felt.standing - force)) continue;
    best = depth;
    best_felt = felt;
  }
  press(best);
  if (std::abs(best_felt.arriving - best_felt.standing) > kMet * force) rows_->stand(kSettles);
}

// What needs no trial to be refused.
void MotionMaker::look_at(const MotionStep& step) const {
  using Kind = MotionStep::Kind;
  if (step.kind == Kind::press && step.value > deepest_press_)
    throw std::runtime_error(
        fmt::format("'{}': a depth of {:.4g} m is more than the body's box has from corner to corner, {:.3g} m; was "
                    "it meant in mm?",
                    step.text, step.value, deepest_press_));
  if (step.kind == Kind::grip && !has_jaws_)
    throw std::runtime_error(fmt::format("'{}': this tool has no jaws", step.text));
  if (step.kind == Kind::grip && widest_jaws_ && step.value > *widest_jaws_)
    throw std::runtime_error(
        fmt::format("'{}': the jaws of this tool open from 0 to {} rad", step.text, *widest_jaws_));
}

void MotionMaker::add(const std::vector<MotionStep>& steps) {
  for (const MotionStep& step : steps) look_at(step);
  for (const MotionStep& step : steps) try_and_add(step);
}

void MotionMaker::try_and_add(const MotionStep& step) try {
  using Kind = MotionStep::Kind;
  if (step.kind != Kind::to && !rows_) throw std::runtime_error("a motion begins with a place: to X,Y,Z");
  const double begin = rows_ ? rows_->time() : 0;
  switch (step.kind) {
    case Kind::to:
      go_to(step.place);
      break;
    case Kind::press:
      press(step.value);
      break;
    case Kind::press_with:
      press_with(step.value);
      break;
    case Kind::hold:
      rows_->stand(step.value);
      break;
    case Kind::slide:
      slide(step.place);
      break;
    case Kind::withdraw:
      press(-manner_.clear);
      break;
    case Kind::grip:
      rows_->grip(step.value, kJaws);
      break;
    case Kind::pedal:
      rows_->pedal(step.value);
      break;
  }
  parts_.push_back({step, begin, rows_->time()});
} catch (const std::runtime_error& error) {
  throw std::runtime_error(fmt::format("'{}': {}", step.text, error.what()));
}

}  // namespace palpate
