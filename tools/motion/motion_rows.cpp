#include "tools/motion/motion_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "common/tool/motion_limits.hpp"
#include "common/tool/row_times.hpp"

namespace palpate {
namespace {

constexpr double kRow = 0.02;         // [s] at most from row to row
constexpr double kPeakSpeed = 1.875;  // of a way with the least jerk, in mean speeds
constexpr double kShortest = 0.1;     // [s] that a way takes

/// How much of a way is gone after a share of its time (Flash and Hogan 1985).
double gone(double s) {
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

/// The point after `length` [m] of a way.
Eigen::Vector3d point_at(const std::vector<Eigen::Vector3d>& points, double length) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double piece = (points[i] - points[i - 1]).norm();
    if (length <= piece && piece > 0) return points[i - 1] + length / piece * (points[i] - points[i - 1]);
    length -= piece;
  }
  return points.back();
}

/// As the file has it: what is tried is what is written.
double rounded(double value, double digits) {
  const double scale = std::pow(10, digits);
  return std::round(value * scale) / scale;
}

}  // namespace

MotionRows::MotionRows(const Trocar& trocar, double reach, const Eigen::Vector3d& tip)
    : trocar_(trocar), reach_(reach), tip_(tip) {
  row(0, tip);
}

void MotionRows::row(double time, const Eigen::Vector3d& tip) {
  tip_ = tip;
  ToolDofs dofs = dofs_for_tip(trocar_, tip, 0);
  dofs.depth -= reach_;
  for (double* dof : {&dofs.yaw, &dofs.pitch, &dofs.depth}) *dof = rounded(*dof, 6);
  dofs.grip = rounded(grip_, 4);
  dofs.pedal = pedal_;
  if (!MotionLimits{}.allow(dofs))
    throw std::runtime_error(fmt::format("no tool can be there: angles are at most {} rad, the depth {} m",
                                         MotionLimits::kMaxAngle, MotionLimits::kMaxDepth));
  if (time > kLatestRow) throw std::runtime_error(fmt::format("a motion ends within {} s", kLatestRow));
  time_.push_back(rounded(time, 4));
  dofs_.push_back(dofs);
}

void MotionRows::go(const std::vector<Eigen::Vector3d>& points, double speed) {
  std::vector<Eigen::Vector3d> way{tip_};
  way.insert(way.end(), points.begin(), points.end());
  double length = 0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  if (length == 0) return;
  const double begin = time(), seconds = std::max(kPeakSpeed * length / speed, kShortest);
  const int rows = static_cast<int>(std::ceil(seconds / kRow));
  for (int i = 1; i <= rows; ++i) {
    const double s = static_cast<double>(i) / rows;
    row(begin + s * seconds, i == rows ? way.back() : point_at(way, gone(s) * length));
  }
}

void MotionRows::stand(double seconds) {
  row(time() + seconds, tip_);
}

void MotionRows::grip(double angle, double seconds) {
  grip_ = angle;
  stand(seconds);
}

void MotionRows::pedal(double down) {
  pedal_ = down;
  stand(kRow);
}

void MotionRows::write(const std::filesystem::path& file, const std::string& comment) const {
  const bool has_pedal = std::ranges::any_of(dofs_, [](const ToolDofs& d) { return d.pedal != 0; });
  std::string text = fmt::format("# {}\ntime,yaw,pitch,depth,roll,grip{}\n", comment, has_pedal ? ",pedal" : "");
  for (std::size_t i = 0; i < time_.size(); ++i) {
    const ToolDofs& d = dofs_[i];
    text += fmt::format("{:.4f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f}", time_[i], d.yaw, d.pitch, d.depth, d.roll, d.grip);
    text += has_pedal ? fmt::format(",{:.0f}\n", d.pedal) : "\n";
  }
  std::ofstream out(file);
  if (!(out << text).flush()) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
}

}  // namespace palpate
