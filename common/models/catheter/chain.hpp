#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/models/catheter/band_matrix.hpp"
#include "common/models/catheter/spec.hpp"

namespace palpate {

/// The catheter's particles with their stretching and bending springs (BHS01 sec. V-C-2, eq. 27), straight at
/// rest.
///
/// Stretching: k_s = E A / l0 between neighbours. Bending: energy EI / (2 l0) |t' - t|^2 for the unit
/// tangents t, t' of segments that meet, I = pi r^4 / 4. |t' - t| is the relative angle Theta of eq. 27 to
/// first order, and EI the paper's k_b; the forces are the exact derivatives of these energies, so that they
/// sum to zero and so do their moments.
class Chain {
 public:
  /// Throws std::runtime_error in words where a number is out of range.
  Chain(const Catheter& shape, double young, double density);

  int size() const { return static_cast<int>(rest_.size()); }
  double spacing() const { return spacing_; }                      ///< [m] at rest
  std::span<const Eigen::Vector3d> rest() const { return rest_; }  ///< [m] from tail to tip
  std::span<const double> mass() const { return mass_; }           ///< [kg], half at the ends

  /// Adds the elastic forces [N] at positions `x`.
  void add_forces(std::span<const Eigen::Vector3d> x, std::span<Eigen::Vector3d> force) const;
  /// Adds the forces' stiffness [N/m], less the parts that may be indefinite (those of compressed springs and
  /// of the tangents' curvature): symmetric, positive semi-definite. `tension` [N], per segment, stiffens it
  /// across: that which will be left, because what linear springs have got by turning is gone at once and
  /// must not hold the catheter fast.
  void add_stiffness(std::span<const Eigen::Vector3d> x, std::span<const double> tension, BandMatrix& stiffness) const;
  /// [N] of a segment at positions `x` after a small motion, by the same linear law; negative where it is
  /// compressed.
  double tension(int segment, std::span<const Eigen::Vector3d> x, std::span<const Eigen::Vector3d> motion) const;
  double elastic_energy(std::span<const Eigen::Vector3d> x) const;  ///< [J]

  /// Upper bound of the angular frequencies [rad/s] of the straight chain, by Gershgorin's circles.
  double frequency_bound() const;

 private:
  double spacing_, stretching_, bending_;  ///< [m], [N/m], [N m] = EI / l0
  std::vector<Eigen::Vector3d> rest_;
  std::vector<double> mass_;
};

}  // namespace palpate
