#pragma once
#include <filesystem>
#include <vector>

#include "common/tool/pose_values.hpp"

namespace palpate {

struct Tool;

/// A tool's motion over time. Between the given rows the dofs follow monotone cubics (Fritsch and Carlson
/// 1980): continuous speed, no overshoot, so that a tool which rests between two equal rows stays at rest.
/// The pedal is a switch: it stays where the last row put it.
class Trajectory {
 public:
  /// `time` [s] increases strictly and is as long as `dofs`; at least one row. Throws std::invalid_argument.
  Trajectory(std::vector<double> time, const std::vector<ToolDofs>& dofs);

  double duration() const { return time_.back(); }            ///< [s] from time 0 to the last row
  const std::vector<double>& times() const { return time_; }  ///< [s] of the rows

  /// Before the first row that row's dofs, after the last one that one's. Allocates nothing.
  ToolDofs at(double time) const;

 private:
  std::vector<double> time_;
  std::vector<PoseValues> value_;
  std::vector<PoseValues> speed_;  ///< per second, at the rows
  std::vector<double> pedal_;
};

/// Reads a CSV file with the header `time,yaw,pitch,depth,roll,grip` [s, rad, rad, m, rad, rad], after which
/// `pedal` (0 or 1) may follow, strictly increasing times and poses where a tool can be (MotionLimits); lines that
/// begin with '#' and empty lines are skipped. Throws std::runtime_error("FILE:LINE: sentence").
Trajectory load_trajectory(const std::filesystem::path& file);

/// Refuses a trajectory whose grip leaves what jaws that turn allow, 0 .. max_open. Throws
/// std::runtime_error("FILE: sentence"), FILE being where the trajectory comes from.
void check_grip(const Trajectory& trajectory, const std::filesystem::path& file, const Tool& tool);

}  // namespace palpate
