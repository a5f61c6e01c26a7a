#pragma once
#include <Eigen/Core>
#include <span>

#include "common/models/catheter/band_matrix.hpp"
#include "common/models/catheter/touch.hpp"

namespace palpate {

/// A straight fixed sleeve from the tail at rest along the resting catheter: what lies in it is held across
/// its axis and is free along it. It goes on behind the tail, so that the catheter can be withdrawn, and its
/// front end stops the tail.
///
/// The particles from the tail on, as long as they lie behind the front end, are held, and so is the point
/// where the next segment passes through that end: springs come and go where they carry nothing.
class Sleeve {
 public:
  static constexpr double kCompliance = 1e-5;  ///< [m/N]

  Sleeve(const Eigen::Vector3d& tail, const Eigen::Vector3d& tip, double length);

  /// Adds the springs at positions x.
  void add_springs(std::span<const Eigen::Vector3d> x, BandMatrix& matrix, std::span<double> right_side) const;

 private:
  void hold(const ChainPoint& point, std::span<const Eigen::Vector3d> x, const Eigen::Matrix3d& stiffness,
            BandMatrix& matrix, std::span<double> right_side, const Eigen::Vector3d& at) const;

  Eigen::Vector3d tail_, axis_;
  double length_;
};

}  // namespace palpate
