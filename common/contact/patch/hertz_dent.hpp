#pragma once
#include <Eigen/Core>

#include "common/contact/patch/half_space.hpp"

namespace palpate {

/// What a ball that presses a half-space with a force does to its surface: Hertz's pressures, and a shear that is
/// spread like them, on a disc (Johnson, Contact Mechanics, 1985, eq. 3.41a, 3.42a; its shear in closed form from the
/// same potential). Within `reach` it is the whole of it, and from half of that on it fades out.
struct HertzDent {
  Eigen::Vector3d middle;   ///< [m] of the surface at rest
  Eigen::Vector3d outward;  ///< unit, of the surface there
  Eigen::Vector3d force;    ///< [N] on the tissue
  double disc;              ///< [m] radius of what is in contact
  double reach;             ///< [m] about the middle
  HalfSpace half_space;

  /// [m] The disc's radius under a ball of `radius` [m] that is pressed with `pressing` [N].
  static double disc_under(double radius, double pressing, const HalfSpace& half_space);

  /// [1] Of the field, as far from the middle as `place` is.
  double share(const Eigen::Vector3d& place) const;
  /// [m] Displacement of a place of the surface at rest, whose unit normal is `normal`, without share(); zero where it
  /// looks the other way.
  Eigen::Vector3d field(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) const;
  /// [m] share() of field().
  Eigen::Vector3d displacement(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) const;
  /// [1] By how much that rises along the normal per way over the surface.
  Eigen::Vector3d slope(const Eigen::Vector3d& place, const Eigen::Vector3d& normal) const;
};

}  // namespace palpate
