#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <span>

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
/// linear radial displacement [m] into the measured one, Q the linear axial force [N] into the measured one.
/// Constant once built; every function is allocation-free.
class QuasiNonlinear {
 public:
  /// Reads the curve files `displacement_m,force_N` and `displacement_m,radial_m` of a loading test and fits
  /// them. Throws std::runtime_error naming file and line on a curve that is not one, on too few points for
  /// the degree and where the force would fall while the tool advances.
  QuasiNonlinear(const Nonlinear& nonlinear, const LinearSlopes& linear);

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

/// The correction that a body's scene asks for: with a specimen mesh the linear slopes come from the archive
/// (stuck ends), otherwise from the closed forms. `body.nonlinear` must be there.
QuasiNonlinear make_quasi_nonlinear(const QuasiStaticSpec& body, const Archive& archive);

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
