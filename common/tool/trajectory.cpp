#include "common/tool/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "common/describe/csv.hpp"
#include "common/tool/instrument.hpp"
#include "common/tool/motion_guard.hpp"
#include "common/tool/row_times.hpp"

namespace palpate {

namespace {

/// Slope at a row from the slopes of the two intervals beside it, h0 and h1 long: a weighted harmonic mean,
/// zero at an extremum, so that neither interval overshoots.
double row_speed(double h0, double slope0, double h1, double slope1) {
  if (slope0 * slope1 <= 0) return 0;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / slope0 + w1 / slope1);
}

}  // namespace

Trajectory::Trajectory(std::vector<double> time, const std::vector<ToolDofs>& dofs) : time_(std::move(time)) {
  const std::size_t n = time_.size();
  if (n == 0 || n != dofs.size()) throw std::invalid_argument("a trajectory needs one time for each row, and a row");
  if (std::ranges::adjacent_find(time_, std::greater_equal<>{}) != time_.end())
    throw std::invalid_argument("a trajectory's times must increase");
  for (const ToolDofs& d : dofs) {
    value_.push_back(pose_values(d));
    pedal_.push_back(d.pedal);
  }
  speed_.assign(n, PoseValues{});
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h0 = time_[i] - time_[i - 1], h1 = time_[i + 1] - time_[i];
    for (std::size_t d = 0; d < speed_[i].size(); ++d)
      speed_[i][d] = row_speed(h0, (value_[i][d] - value_[i - 1][d]) / h0, h1, (value_[i + 1][d] - value_[i][d]) / h1);
  }
}

ToolDofs Trajectory::at(double time) const {
  PoseValues now;
  std::size_t i = 0;
  if (!(time > time_.front())) {
    now = value_.front();
  } else if (time >= time_.back()) {
    i = time_.size() - 1;
    now = value_.back();
  } else {
    i = std::upper_bound(time_.begin(), time_.end(), time) - time_.begin() - 1;
    const double h = time_[i + 1] - time_[i], s = (time - time_[i]) / h;
    const double b = s * s * (3 - 2 * s), c = s * (1 - s) * (1 - s) * h, d = s * s * (s - 1) * h;  // Hermite
    for (std::size_t k = 0; k < now.size(); ++k)
      now[k] = value_[i][k] + b * (value_[i + 1][k] - value_[i][k]) + c * speed_[i][k] + d * speed_[i + 1][k];
  }
  return dofs_of(now, pedal_[i]);
}

Trajectory load_trajectory(const std::filesystem::path& file) {
  const CsvTable table = read_csv(file, {"time", "yaw", "pitch", "depth", "roll", "grip"}, "pedal");
  std::vector<double> time;
  std::vector<ToolDofs> dofs;
  for (const CsvRow& row : table.rows) {
    const std::vector<double>& v = row.values;
    if (!time.empty() && !(v[0] > time.back()))
      table.fail(row.line, fmt::format("time {} does not come after {}", v[0], time.back()));
    if (std::abs(v[0]) > kLatestRow || (!time.empty() && v[0] - time.back() < kRowsApart))
      table.fail(row.line,
                 fmt::format("time {} s: rows are {} s apart at least, and within {} s", v[0], kRowsApart, kLatestRow));
    time.push_back(v[0]);
    const double pedal = v.size() > 6 ? v[6] : 0;
    if (pedal != 0 && pedal != 1) table.fail(row.line, fmt::format("pedal must be 0 or 1, and is {}", pedal));
    dofs.push_back({.yaw = v[1], .pitch = v[2], .depth = v[3], .roll = v[4], .grip = v[5], .pedal = pedal});
    if (!MotionLimits{}.allow(dofs.back()))
      table.fail(row.line, fmt::format("no tool can be there: angles are at most {} rad, the depth {} m",
                                       MotionLimits::kMaxAngle, MotionLimits::kMaxDepth));
  }
  return {std::move(time), dofs};
}

void check_grip(const Trajectory& trajectory, const std::filesystem::path& file, const Tool& tool) {
  const auto jaws = abilities_of(tool).turning;
  if (!jaws) return;
  for (double time : trajectory.times()) {  // between the rows nothing overshoots
    const double grip = trajectory.at(time).grip;
    if (grip >= 0 && grip <= jaws->max_open) continue;
    throw std::runtime_error(
        fmt::format("{}: the grip of {} rad at {} s is out of range: the jaws of '{}' open from 0 to {} rad",
                    file.string(), grip, time, tool.name, jaws->max_open));
  }
}

}  // namespace palpate
