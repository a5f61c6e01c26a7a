#pragma once
#include "tools/study/patches.hpp"
#include "tools/study/result.hpp"

namespace palpate::study {

/// What a press did: force along the press, displacement of every surface node.
struct PressAnswer {
  double force = 0;                           ///< [N] on the tissue, along the press
  std::vector<Eigen::Vector3d> displacement;  ///< [m] per surface node of the body's map
};

using PressAnswers = std::vector<std::vector<PressAnswer>>;  ///< patch by patch, depth by depth

/// Compares presses of one body by one set of patches.
class PressErrors {
 public:
  PressErrors(std::vector<double> area, Presses presses) : area_(std::move(area)), presses_(std::move(presses)) {}

  const Presses& presses() const { return presses_; }
  /// [1] relative difference of two fields in the area's mean square.
  double of_field(const std::vector<Eigen::Vector3d>& u, const std::vector<Eigen::Vector3d>& reference) const;
  /// Adds a row with the root mean squares of the relative errors over patches and depths, and a row per
  /// press; `cost` has everything but errors and reference. Depths that the reference lacks, or without force
  /// in it, are left out. Throws std::runtime_error where a press gives no number.
  void add(const Row& cost, const PressAnswers& ours, const PressAnswers& reference, const std::string& name,
           Result& result) const;

 private:
  std::vector<double> area_;  // [m^2] per surface node
  Presses presses_;
};

/// [m] depth of a ball in motion: from a twentieth of its radius above the surface to three tenths below,
/// without jerk, within `ramp` [s].
double course_depth(double time, double ramp, double radius);

/// Root mean square differences against root mean squares of two courses of (force, displacement); fills in
/// the row's errors, and a line of course.csv per `step` [s]. Throws std::runtime_error where a moment has no number.
void add_course(Row row, const std::vector<std::array<double, 2>>& ours,
                const std::vector<std::array<double, 2>>& reference, double step, Result& result);

}  // namespace palpate::study
