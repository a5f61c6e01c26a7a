#include "tools/generate/scripted_motion.hpp"

#include <fmt/format.h>

#include <cmath>

namespace palpate {
namespace {

using Eigen::Vector3d;

/// Rounded to six places, without a negative zero.
double rounded(double x) {
  return std::round(x * 1e6) / 1e6 + 0.0;
}

Vector3d shaft_direction(const Trocar& trocar, const JawTarget& target) {
  return (target.point - trocar.pivot).normalized();
}

}  // namespace

ToolDofs dofs_for_jaws(const Trocar& trocar, const JawTarget& target) {
  const Vector3d along = shaft_direction(trocar, target);
  const Vector3d joint = target.point - target.ahead * along;
  const Eigen::Matrix3d plain = tip_pose(trocar, dofs_for_tip(trocar, joint, 0)).linear();
  return dofs_for_tip(trocar, joint, std::atan2(target.across.dot(plain.col(1)), target.across.dot(plain.col(0))));
}

double jaw_distance(const Trocar& trocar, const JawTarget& target, double opening) {
  const Eigen::Isometry3d tip = tip_pose(trocar, dofs_for_jaws(trocar, target));
  const Vector3d jaw = tip.linear() * Vector3d(0, std::sin(0.5 * opening), std::cos(0.5 * opening));
  const Vector3d both = jaw.cross(target.across).normalized();
  return std::abs(both.dot(target.point - tip.translation()));
}

ScriptedMotion::ScriptedMotion(const Tool& tool, const JawTarget& start, double grip)
    : trocar_(make_trocar(tool.pivot, tool.axis, tool.up)), target_(start) {
  ToolDofs dofs = dofs_for_jaws(trocar_, start);
  dofs.grip = grip;
  add(0, dofs);
}

void ScriptedMotion::add(double time, const ToolDofs& dofs) {
  time_.push_back(time);
  dofs_.push_back(dofs);
}

void ScriptedMotion::wait(double seconds) {
  add(time() + seconds, dofs_.back());
}

void ScriptedMotion::move(double seconds, const JawTarget& target) {
  constexpr int kRows = 4;
  const JawTarget from = target_;
  const double begin = time(), grip = dofs_.back().grip;
  for (int i = 1; i <= kRows; ++i) {
    const double t = static_cast<double>(i) / kRows, s = t * t * (3 - 2 * t);
    const auto between = [&](const auto& a, const auto& b) { return ((1 - s) * a + s * b).eval(); };
    ToolDofs dofs = dofs_for_jaws(trocar_, {between(from.point, target.point), between(from.across, target.across),
                                            (1 - s) * from.ahead + s * target.ahead});
    dofs.grip = grip;
    add(begin + t * seconds, dofs);
  }
  target_ = target;
  wait(0.1);
}

void ScriptedMotion::grip(double seconds, double opening) {
  ToolDofs dofs = dofs_.back();
  dofs.grip = opening;
  add(time() + seconds, dofs);
  wait(0.1);
}

std::string ScriptedMotion::csv(const std::string& comment) const {
  std::string text = fmt::format("# {}\ntime,yaw,pitch,depth,roll,grip\n", comment);
  for (std::size_t i = 0; i < time_.size(); ++i) {
    const ToolDofs& d = dofs_[i];
    text += fmt::format("{:.3f},{:.6f},{:.6f},{:.6f},{:.6f},{:.3f}\n", time_[i], rounded(d.yaw), rounded(d.pitch),
                        rounded(d.depth), rounded(d.roll), d.grip);
  }
  return text;
}

}  // namespace palpate
