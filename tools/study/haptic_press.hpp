#pragma once
#include "common/sim/deformer.hpp"
#include "common/sim/haptic_step.hpp"
#include "tools/study/measure.hpp"
#include "tools/study/patches.hpp"
#include "tools/study/solid_case.hpp"

namespace palpate::study {

/// Presses one body with a ball through the product's own haptic step, and shows it through its own deformer.
class HapticPress {
 public:
  /// `radius` [m]: from the ball's centre to where it touches; a wall's half thickness is in it. `scene`: one
  /// body, one tool, as SolidCase::press_scene() makes it. `shown`: read or computed with all its parts.
  HapticPress(Scene scene, const std::vector<Archive>& archives, const Patch& patch, double radius);

  /// Brings the ball to a depth [m] in steps of a hundredth of its radius and lets the contact settle for so
  /// many steps.
  PressAnswer to(double depth, int settling = 40);
  /// Times [s] of steps while the ball trembles by a thousandth of its radius about its present depth.
  std::vector<double> time(int count);
  /// One step with the ball at a depth [m]; force along the press [N].
  double step(double depth);
  const HapticStep& haptic() const { return haptic_; }
  std::vector<Eigen::Vector3d> shown();         ///< [m] displacement of all surface nodes by the deformer
  std::size_t bytes() const { return bytes_; }  ///< that step and deformer took

 private:
  ContactState contacts() const;

  Scene scene_;
  Patch patch_;
  double radius_, depth_;
  std::size_t before_;
  HapticStep haptic_;
  Deformer deformer_;
  std::size_t bytes_;
  Trocar trocar_;
  std::uint64_t count_ = 0;
};

}  // namespace palpate::study
