#pragma once
#include "common/models/catheter/catheter_body.hpp"
#include "common/tool/passivity_spec.hpp"
#include "tools/rig/press_rig.hpp"
#include "tools/stability/case.hpp"

namespace palpate::stability {

/// Follows a haptic step and says how it went.
class Watch {
 public:
  /// [N m] to a hand, beyond which it counts as unbounded: contacts that pull against one another add up to little
  /// force.
  static constexpr double kMaxTorque = 100;

  /// Looks at the step that has just been made.
  void look(const HapticStep& haptic);
  /// The outcome so far: regularised as soon as any flag was up; failed if the hand has gained more than `reserve` [J].
  Result result(double reserve = Passivity{}.reserve) const;
  double largest() const { return largest_; }

 private:
  double largest_ = 0, torque_ = 0, max_lost_ = 0;
  bool finite_ = true;
  int steps_ = 0, regularised_ = 0, limited_ = 0, slewed_ = 0, faults_ = 0, stale_ = 0, damped_ = 0;
};

/// [m] from rest: the farthest that a node is which something of the body still hangs on.
double reach_of(const DynamicOrgan& organ);
/// [J] of all tools' forces on a body of the tissue, in the tick that has just been made.
double work_on(const DynamicWorld& tissue, int organ);

/// What happens to moving tissue, tick by tick.
class TissueWatch {
 public:
  /// `work` [J]: of the tools' forces on the tissue in this tick.
  void look(const DynamicOrgan& organ, double work);
  /// Judged as StandJudge does what does not stand still: failed where a node went farther than its share of the
  /// diagonal, of what hangs on nothing any more as far as it is followed, or where the tissue had more energy than the
  /// work by more than its share. max_force is the largest contact force on the tissue that moves [N]; energy_growth
  /// the most that the tissue had beyond the work.
  Result result() const;
  /// Judges it by the first alone where other than tools' work goes into it, as weight does: not by `energy`.
  void judge(Result& row, bool energy) const;

 private:
  double largest_ = 0, work_ = 0, max_work_ = 0, gained_ = 0, reach_ = 0, diagonal_ = 0;
  bool whole_ = true;
};

/// What happens to a catheter, tick by tick.
class CatheterWatch {
 public:
  static constexpr double kReach = 1;  ///< [m] from the origin: some lengths of the cases' catheters

  void look(const CatheterBody& body);
  /// Failed if a place or a force was not a number or the catheter went farther away than kReach; max_force is that of
  /// a tool [N].
  Result result(double energy_growth) const;

 private:
  double force_ = 0, reach_ = 0;
};

}  // namespace palpate::stability
