#pragma once
#include "tools/rig/press_rig.hpp"
#include "tools/study/patches.hpp"
#include "tools/study/press_errors.hpp"

namespace palpate::study {

/// A scene of one body, as `from` has its contacts and rates, under a frictionless ball that comes to a patch along its
/// press. Nothing limits the ball's force.
Scene ball_scene(const Scene& from, Body body, const Patch& patch, double radius);

/// [bytes] that what owns the state of a scene's one body takes, and what shows it.
std::size_t owner_bytes(const Scene& scene, const Archive& archive);

/// Presses one body with a ball, tick by tick, by what owns the body's state in the product: see PressRig::press().
class BallPress {
 public:
  /// `radius` [m]: from the ball's centre to where it touches; a wall's half thickness is in it. `scene`: as
  /// ball_scene() makes it. `archive`: read or computed with all its parts.
  BallPress(const Scene& scene, const Archive& archive, const Patch& patch, double radius);

  /// One tick, at whose end the ball is at a depth [m]; force along the press on the tissue [N].
  double step(double depth);
  /// Brings the ball to a depth [m] evenly in so many ticks; returns the last one's force.
  double bring(double depth, int ticks);
  /// Brings the ball to a depth [m] in ticks of a hundredth of its radius, and lets it rest there for so many more.
  PressAnswer to(double depth, int settling = 40);
  /// Rests until force and shape have settled to a ten-thousandth within 50 ms, or `seconds` have passed. Returns the
  /// mean force of the last 50 ms.
  double settle(double seconds);
  /// Times [s] of ticks while the ball trembles by a thousandth of its radius about its present depth.
  std::vector<double> time(int warm_up, int count);

  std::vector<Eigen::Vector3d> displacement() { return rig_.displacement(); }  ///< [m] per node of the surface map
  /// [m] mean displacement along the press of three of the nodes of a field.
  double along(const std::vector<Eigen::Vector3d>& u, const std::array<int, 3>& nodes) const;
  PressRig& rig() { return rig_; }

 private:
  std::array<ToolDofs, 1> at(double depth) const;

  PressRig rig_;
  Patch patch_;
  Trocar trocar_;
  double radius_, depth_;
};

}  // namespace palpate::study
