#pragma once
#include <Eigen/Core>
#include <array>

namespace palpate {

/// How a tool was handled: what trainers compare.
struct HandlingFigures {
  double seconds = 0;
  double path = 0;        ///< [m] of the tip
  double economy = 1;     ///< of what it went in free air: the straight lines from touch to touch over the way taken
  double jerk = 0;        ///< [m/s^3] rms of the tip's third derivative, from its places every 20 ms
  double touching = 0;    ///< [s] with a force
  int touches = 0;        ///< begun; one that is interrupted for less than 50 ms goes on
  double max_force = 0;   ///< [N]
  double mean_force = 0;  ///< [N] while it touches
  double impulse = 0;     ///< [N s] the force's size over time
  double max_change = 0;  ///< [N] from a step to the next
};

/// Follows one tool from step to step. Nothing is allocated.
class Handling {
 public:
  /// `time` [s] that does not go back, the tip's place [m] and the force [N] on the tool, both in the world.
  void look(double time, const Eigen::Vector3d& tip, const Eigen::Vector3d& force);
  HandlingFigures figures() const;

 private:
  void take_places(double time, const Eigen::Vector3d& tip);
  void take_place(const Eigen::Vector3d& tip);
  void note_touch(double time, const Eigen::Vector3d& tip, bool touches);

  double begin_ = 0, time_ = 0;
  bool begun_ = false;
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero(), force_ = Eigen::Vector3d::Zero();
  HandlingFigures sum_;

  // Places every 20 ms, the newest last.
  std::array<Eigen::Vector3d, 4> place_;
  int places_ = 0;
  double next_place_ = 0, jerk_squares_ = 0;
  int jerks_ = 0;

  // The way through free air.
  bool touches_ = false;
  double last_touch_ = 0;                              ///< [s] when there was a force
  Eigen::Vector3d set_out_ = Eigen::Vector3d::Zero();  ///< where the present way through the air began
  double straight_ = 0, air_ = 0;                      ///< [m] of the ways that are over, and of all
};

}  // namespace palpate
