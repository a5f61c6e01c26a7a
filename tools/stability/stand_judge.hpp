#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/stability/case.hpp"

namespace palpate::stability {

/// Judges moving tissue under a tool that comes to a stand: stable is what keeps within all of these bounds.
class StandJudge {
 public:
  static constexpr double kDeviation = 0.02;     ///< [1] of the mean force along the press, from the static answer
  static constexpr double kChatter = 0.005;      ///< [1] of the static force: rms of the force about its mean
  static constexpr double kAlternation = 0.002;  ///< [1] of the static force: rms of what turns round from tick to tick
  static constexpr double kEnergy = 0.02;  ///< [1] of the most work put in: what the tissue may have beyond the work
  static constexpr double kReach = 0.5;    ///< [1] of the body's diagonal: how far a node may go
  static constexpr int kWindow = 500;      ///< [ticks] at the end, for the first three

  /// A tick: the force that the tool puts on the tissue [N], the work of all its forces on the tissue in the tick
  /// [J], the tissue's elastic and kinetic energy [J], and the farthest that a node is from rest [m].
  void look(const Eigen::Vector3d& force, double work, double energy, double reach);

  /// `static_force` [N]: of the same contact at rest, along the unit vector `press`. `diagonal` [m]: of the body.
  /// max_force is the largest in the window, energy_growth the most that the tissue had beyond the work put in; the
  /// note has what was measured and what it misses.
  Result result(double static_force, const Eigen::Vector3d& press, double diagonal) const;

 private:
  std::vector<Eigen::Vector3d> force_;
  double work_ = 0, max_work_ = 0, gained_ = 0, reach_ = 0;
};

}  // namespace palpate::stability
