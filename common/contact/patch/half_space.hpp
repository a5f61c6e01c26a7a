#pragma once
#include <Eigen/Core>
#include <array>

#include "common/geometry/triangle.hpp"

namespace palpate {

/// An elastic half-space under tractions on its plane surface (Boussinesq 1885, Cerruti 1882).
struct HalfSpace {
  double young = 1;    ///< [Pa]
  double poisson = 0;  ///< [1]

  double scale() const;  ///< [1/Pa] (1 + nu) / (pi E), which all of this is in proportion to

  /// [m/N] displacement at `d` [m] from a unit point force; `normal` is the surface's, outward. Infinite at d = 0.
  Eigen::Matrix3d at(const Eigen::Vector3d& d, const Eigen::Vector3d& normal) const;

  /// What a rectangle's corner at (x, y) [m] gives to what the tractions on all of it do [m]: the sums over its
  /// corners, with signs + - - + in turn, are what pressed() and sheared() take.
  struct Corner {
    double across, along, mixed;
  };
  static Corner corner(double x, double y);
  double pressed(const Corner& sum) const;           ///< [m/Pa]
  Eigen::Matrix2d sheared(const Corner& sum) const;  ///< [m/Pa]

  /// [m/Pa] along the normal, at (x, y) [m] from the middle of a square of edge `a` [m] under unit pressure (Love
  /// 1929).
  double pressed(double x, double y, double a) const;
  /// [m/Pa] within the surface, likewise, per unit shear along x and y.
  Eigen::Matrix2d sheared(double x, double y, double a) const;
  /// [m/Pa] Into the surface, likewise; along x and y per unit pressure it is the opposite: tissue that can be
  /// compressed is drawn towards what presses.
  Eigen::Vector2d crossed(double x, double y, double a) const;
  /// [m/Pa] The same, of a rectangle, as the sum over its corners (see Corner).
  Eigen::Vector2d crossed_corner(double x, double y) const;
};

/// Moments of the half-space's kernel between two triangles of a surface.
/// [a][b] = integral over s of L_a(x), integral over t of L_b(y), K(x - y) dy dx [m^5/N], L being the barycentric
/// coordinates. `normal`: unit, of the surface about both. Where the triangles are near each other the inner integral
/// is taken in polar coordinates about x, in which 1/r is no singularity.
std::array<std::array<Eigen::Matrix3d, 3>, 3> kernel_moments(const HalfSpace& half_space, const Triangle& s,
                                                             const Triangle& t, const Eigen::Vector3d& normal);

}  // namespace palpate
