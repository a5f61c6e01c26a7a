#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/describe/state.hpp"
#include "common/tool/passivity_spec.hpp"
#include "common/tool/port.hpp"

namespace palpate {

/// The port of one tool under the watch: what its tool and the guard say to each other within a tick, and what the
/// guard remembers of it.
struct Port {
  /// By how much the next motion may differ from the last one.
  struct Reach {
    double shift = 0, turn = 0, opening = 0;  ///< [m], [rad], [rad]
  };
  PortMotion motion;     ///< of this tick, before PassivityGuard::observe()
  PortForce asked;       ///< before PassivityGuard::control(), which leaves of it what may be given
  PortForce held;        ///< what the hand really gets until the next tick
  bool limited = false;  ///< by the last control()
  double spare = 0;      ///< [J] after it: what a force that is held on to may put into the hand; 0 where it limited

  PortMotion last;  ///< the motion that was observed before
  Reach reach;
  double resisting = 0;  ///< [N] that may stand against the motion whatever the energy is
};

/// Passivity observer and controller in the time domain (B. Hannaford and J.-H. Ryu, "Time-domain passivity control of
/// haptic interfaces", IEEE Trans. Robotics and Automation 18(1), 2002) over the ports of all tools together: one tool
/// may take out what another has put in.
///
/// Observer: the force given at a tick is held until the next, so the energy put into the tissue grows by -F_k .
/// (x_{k+1} - x_k), exactly, however the hand moves in between. Controller: the next motion is unknown, but differs
/// from the last one by no more than a reach, so that F_k takes out at most F_k . dx_k + |F_k| reach. If that
/// could bring the energy below -reserve, first the parts that push along their motion are damped, then the whole force
/// is made smaller; the slew limit does not hold on to what is taken away so (SafetyChain). A force that resists is
/// left at least as large as a sampled damper of max_damping / dt, as far as a share of the reserve that is kept for it
/// allows; so a force that was taken away earns its return. The energy falls below -reserve only where a motion changes
/// by more than the reach, by that jump times the force. Never allocates after construction.
class PassivityGuard : public Stateful<PassivityGuard> {
 public:
  static constexpr double kMaxDamping =
      0.02;  ///< [kg] damping times tick: well below twice the mass of a hand on a device
  static constexpr double kMaxAcceleration = 100;  ///< [m/s^2] to be reckoned with before any has been seen
  static constexpr double kMemory =
      0.1;  ///< [s] for which a larger change of motion is reckoned with, while more than half the reserve is left
  static constexpr double kMemoryInDebt = 2;  ///< [s] the same while less is left: the time of a hand that rests
  static constexpr double kLever = 0.3;       ///< [m] from reach to angular reach
  static constexpr double kForResisting =
      0.05;                                ///< share of the reserve that is kept for resisting while all else is gone
  static constexpr double kStill = 1e-12;  ///< [m, rad] less is no motion

  /// `ports`: of all tools, which outlive the guard. max_force: the sum of all their limits [N]. The reach is
  /// max_acceleration dt^2, or less where that times max_force were over half the reserve, or the largest change seen
  /// lately.
  PassivityGuard(const Passivity& settings, std::vector<Port*> ports, double max_force, double dt);

  /// A tick begins: counts the energy of what the ports held over their motion.
  void observe();
  /// Damps and limits what the ports ask for where the energy could fall too low. What is not finite is left.
  void control();

  double energy() const { return energy_; }  ///< [J] put in by all tools; negative: taken out

  /// Everything that the next tick depends on, as bytes.
  void state(State& s);

 private:
  /// Energy of all tools until the next tick [J]: at most taken out by some, surely put in by the others.
  struct Outlook {
    double risk = 0, income = 0;
  };

  bool rests(const PortMotion& motion) const;
  double risk(const Port& port) const;
  Outlook outlook() const;
  double affordable_resistance(double left) const;
  void damp_pushes(double missing);
  double fair_risk(double in_all) const;
  void shrink(double spare);
  void resist();

  bool controller_;
  double reserve_, max_per_shift_, fade_, fade_in_debt_, energy_ = 0;  ///< max_per_shift_ [N/m] on the motion of a tick
  Port::Reach min_reach_;
  std::vector<Port*> ports_;
};

}  // namespace palpate
