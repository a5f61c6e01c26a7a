#include "tools/motion/motion_maker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

constexpr double kAlong = 0.002;  // [m] from place to place of a slide
constexpr double kDeepest = 4;    // radii to which a force is looked for
constexpr double kJaws = 0.3;     // [s] to open or shut

}  // namespace

MotionMaker::MotionMaker(const Tool& tool, const SurfaceMap& map, const Rehearsal& rehearsal,
                         const MotionManner& manner)
    : surface_(map),
      rehearsal_(rehearsal),
      manner_(manner),
      trocar_(make_trocar(tool.pivot, tool.axis, tool.up)),
      radius_(abilities_of(tool).radius) {
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
  if (!rows_) return void(rows_.emplace(trocar_, tip));
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

// Pressed on and on, as slowly as the rest is done, until the force is there.
double MotionMaker::depth_for(double force) const {
  MotionRows trial = *rows_;
  const double begin = trial.time();
  const Eigen::Vector3d from = place_->point - radius_ * place_->inward;
  trial.go({tip_at(*place_, kDeepest * radius_)}, manner_.speed);
  const Trajectory motion = trial.trajectory();
  const std::vector<double> felt = rehearsal_.forces(motion);
  double most = 0;
  for (auto i = static_cast<std::size_t>(begin / rehearsal_.dt()); i < felt.size(); ++i) {
    most = std::max(most, felt[i]);
    if (felt[i] < force) continue;
    const ToolDofs dofs = motion.at(static_cast<double>(i) * rehearsal_.dt());
    return (tip_pose(trocar_, dofs).translation() - from).dot(place_->inward);
  }
  throw std::runtime_error(
      fmt::format("there the force is at most {:.3g} N, {:.0f} mm deep", most, 1e3 * kDeepest * radius_));
}

void MotionMaker::add(const MotionStep& step) try {
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
      press(depth_for(step.value));
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
  parts_.push_back({step.text, begin, rows_->time()});
} catch (const std::runtime_error& error) {
  throw std::runtime_error(fmt::format("'{}': {}", step.text, error.what()));
}

}  // namespace palpate
