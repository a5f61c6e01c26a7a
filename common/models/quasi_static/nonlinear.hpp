#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <vector>

#include "common/archive/archive.hpp"
#include "common/models/quasi_static/fitted_curve.hpp"
#include "common/models/quasi_static/spec.hpp"

namespace palpate {

/// How the linear model answers a press of the specimen by x: d_r^L = radial x, f^L = force x.
struct LinearSlopes {
  double force;   ///< [N/m]
  double radial;  ///< [1]
};

/// Ends free to slide: f^L = s E x/h with s = pi r^2, d_r^L = nu r x/h (TVCG99 sec. 3-4).
LinearSlopes sliding_slopes(const Material& material, double radius, double height);

/// The quasi non-linear correction of a linear answer (TVCG99 sec. 3-4 and 4-3) as fitted curves: P turns the
/// linear radial displacement [m] into the true one, Q the linear axial force [N] into the true one.
/// Every function is allocation-free.
class QuasiNonlinear {
 public:
  QuasiNonlinear() = default;
  QuasiNonlinear(const FittedCurve& force, const FittedCurve& radial) : force_(force), radial_(radial) {}

  /// Adds a share of another correction: see FittedCurve::add().
  void add(double share, const QuasiNonlinear& other) {
    force_.add(share, other.force_);
    radial_.add(share, other.radial_);
  }

  /// Q(F)/F for the resultant F [N] of one tool's linear contact force along its press: the factor for all of
  /// that tool's nodal forces. (TVCG99 eq. 6 applies Q node by node, which makes the force depend on the
  /// mesh.)
  double force_scale(double force) const { return force_.ratio(force); }
  double force_slope(double force) const { return force_.slope(force); }  ///< Q'(F), positive

  /// P(s)/s for the length s [m] of a linear radial displacement; P'(0) at s = 0.
  double radial_scale(double length) const { return radial_.ratio(length); }

  /// One node's displacement [m] of one tool's press (TVCG99 eq. 3-4): the part across `press` (unit, world)
  /// is scaled, the part along it stays. Without a press (zero) the linear displacement is returned.
  Eigen::Vector3d correct(const Eigen::Vector3d& linear, const Eigen::Vector3d& press) const {
    if (press.isZero(0)) return linear;
    const Eigen::Vector3d along = linear.dot(press) * press, across = linear - along;
    return along + radial_scale(across.norm()) * across;
  }

  const FittedCurve& force_curve() const { return force_; }    ///< Q
  const FittedCurve& radial_curve() const { return radial_; }  ///< P

 private:
  FittedCurve force_, radial_;
};

/// Reads the curve files `displacement_m,force_N` and `displacement_m,radial_m` of a loading test and fits
/// them. Throws std::runtime_error naming file and line on a curve that is not one, on too few points for
/// the degree and where the force would fall while the tool advances.
QuasiNonlinear measured_correction(const MeasuredLaw& law, const LinearSlopes& linear);

/// The correction of a body, which may differ from place to place. Every function is allocation-free.
class BodyNonlinear {
 public:
  explicit BodyNonlinear(const QuasiNonlinear& everywhere) : law_{everywhere} {}
  /// Curves fitted to the presses of each place; at least one.
  explicit BodyNonlinear(const std::vector<PressedPlace>& presses);

  /// That of a tool which presses at `place` [m] on the rest surface: the places' own, by weights d^-4 with d the
  /// distance from each. At a place it is that place's, between them it goes over evenly.
  QuasiNonlinear at(const Eigen::Vector3d& place) const;

 private:
  std::vector<Eigen::Vector3d> place_;  ///< empty: the same everywhere
  std::vector<QuasiNonlinear> law_;
};

/// The correction that a body's scene asks for: that of measured curves, whose linear slopes come from the archive with
/// a specimen mesh (stuck ends), otherwise from the closed forms; or that of the archive's presses. `body.nonlinear`
/// must be there. Throws as measured_correction() does, and where the archive lacks what it asks for.
BodyNonlinear make_nonlinear(const QuasiStaticSpec& body, const Archive& archive);

/// Where one tool presses on a body's rest surface: the mean of the nodes that it loads, by the sizes of their forces.
class PressPlace {
 public:
  void add(const Eigen::Vector3d& node, double force) {
    sum_ += force * node;
    force_ += force;
  }
  /// [m]; zero without force.
  Eigen::Vector3d mean() const { return force_ > 0 ? Eigen::Vector3d(sum_ / force_) : Eigen::Vector3d::Zero(); }

 private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();  ///< [N m]
  double force_ = 0;                               ///< [N]
};

/// A body's corrected field: add_corrected() for each tool's own linear field, then keep_held() with the linear field
/// of all together. Fields have three entries [m] a node.

/// Adds P of one tool's field to `total`.
template <class Scalar>
void add_corrected(const QuasiNonlinear& law, std::span<const Scalar> linear, const Eigen::Vector3d& press,
                   std::span<Scalar> total);
/// What is held stays where it is held: `held` nodes of `total` become those of `linear`.
template <class Scalar>
void keep_held(std::span<const int> held, std::span<const Scalar> linear, std::span<Scalar> total);

extern template void add_corrected(const QuasiNonlinear&, std::span<const float>, const Eigen::Vector3d&,
                                   std::span<float>);
extern template void add_corrected(const QuasiNonlinear&, std::span<const double>, const Eigen::Vector3d&,
                                   std::span<double>);
extern template void keep_held(std::span<const int>, std::span<const float>, std::span<float>);
extern template void keep_held(std::span<const int>, std::span<const double>, std::span<double>);

}  // namespace palpate
