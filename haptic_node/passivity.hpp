#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/scene/scene.hpp"

namespace palpate {

/// What the hand gets of one tool at its tip, world frame, and at its handle.
struct PortForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the tool
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< [N m] on the tool
  double grip = 0;                                   ///< [N m] on the handle, opens the jaws
};

/// How one tool moved from the last tick to this one.
struct PortMotion {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< [m] of the tip
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();   ///< [rad] rotation vector
  double opening = 0;                               ///< [rad] of the handle
};

/// The motion between two poses of the tip frame.
PortMotion motion_between(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, double opening);

/// Passivity observer and controller in the time domain (B. Hannaford and J.-H. Ryu, "Time-domain passivity control of
/// haptic interfaces", IEEE Trans. Robotics and Automation 18(1), 2002) over the ports of all tools together: one tool
/// may take out what another has put in.
///
/// Observer: the force given at a tick is held until the next, so the energy put into the tissue grows by -F_k . (x_{k+1} - x_k),
/// exactly, however the hand moves in between. Controller: if F_k over a motion like the last one would bring the energy
/// below -reserve, the parts of F_k that push along their motion are damped by what is missing, never by more than they
/// push; what has been taken out too much already is asked back by a further damping of at most most_damping / dt.
/// A force against the motion is never touched. Never allocates after construction.
class PassivityGuard {
 public:
  static constexpr double most_damping = 0.02;        ///< [kg] damping times tick: well below twice the mass of a hand on a device
  static constexpr double most_acceleration = 100;    ///< [m/s^2] by which the motion may speed up until the next tick
  static constexpr double still = 1e-12;              ///< [m, rad] less is no motion

  /// `most_force` [N]: sum of the tools' force limits. So much of the reserve is kept for motion that speeds up or turns
  /// round within a tick as this force gives over most_acceleration, at most half of it.
  PassivityGuard(const Passivity& settings, int tools, double most_force, double dt);

  /// A tick begins: counts the energy of what hold() gave over this motion, one entry per tool.
  void observe(std::span<const PortMotion> motion);
  /// Damps what is asked for, one entry per tool, where the energy would fall too low. Entries that are not finite are left.
  void control(std::span<PortForce> asked);
  /// What the tool's hand really gets until the next tick.
  void hold(int tool, const PortForce& given) { held_[tool] = given; }

  double energy() const { return energy_; }                       ///< [J] put in by all tools; negative: taken out
  bool limited(int tool) const { return limited_[tool] != 0; }    ///< by the last control()

  /// Everything that the next tick depends on, as bytes.
  std::size_t state_size() const { return sizeof(double) + held_.size() * 7 * sizeof(double); }
  void save(unsigned char* to) const;
  void restore(const unsigned char* from);

 private:
  void repay(std::span<PortForce> asked, double missing);

  bool controller_;
  double dt_, lowest_, energy_ = 0;  ///< lowest_ [J]: where damping begins
  std::vector<PortForce> held_;
  std::vector<PortMotion> motion_;
  std::vector<std::uint8_t> limited_;
};

}  // namespace palpate
