#pragma once
#include <filesystem>
#include <vector>

#include "common/tool/trajectory.hpp"

namespace palpate {

/// The rows of a trajectory in the making. A way is gone with the least jerk: it sets out and arrives gently. What no
/// file may hold (load_trajectory) throws std::runtime_error at once.
class MotionRows {
 public:
  /// Stands at a place [m] at time 0. `reach` [m]: how far along the shaft the tip is before the frame's origin.
  MotionRows(const Trocar& trocar, double reach, const Eigen::Vector3d& tip);

  /// Leads the tip along points [m], at `speed` [m/s] in the middle.
  void go(const std::vector<Eigen::Vector3d>& points, double speed);
  void stand(double seconds);
  /// Opens or shuts the jaws [rad] within so long [s], or puts the pedal (0, 1) down or up at once.
  void grip(double angle, double seconds);
  void pedal(double down);

  double time() const { return time_.back(); }  ///< [s] of the last row
  const Eigen::Vector3d& tip() const { return tip_; }
  Trajectory trajectory() const { return {time_, dofs_}; }
  /// Throws std::runtime_error if it cannot be written.
  void write(const std::filesystem::path& file, const std::string& comment) const;

 private:
  void row(double time, const Eigen::Vector3d& tip);

  Trocar trocar_;
  double reach_;
  Eigen::Vector3d tip_;
  double grip_ = 0, pedal_ = 0;
  std::vector<double> time_;
  std::vector<ToolDofs> dofs_;
};

}  // namespace palpate
