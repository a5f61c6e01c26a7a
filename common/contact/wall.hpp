#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "common/contact/touch_surface.hpp"
#include "common/geometry/anchor.hpp"

namespace palpate {

/// A force on the wall of what is led into the duct.
struct WallForce {
  Anchor anchor;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< [N] on the wall, world
};

/// The wall of a duct as a body that is led into it meets it in one step, and how it gives way.
///
/// The wall moves by reduced coordinates y [kg^1/2 m]: its displacement within the step, taken as h times the
/// velocity at the step's end, is w = B y at an anchor, with B (3 x modes) the anchor's rows of the mode
/// shapes. Forces F [N] on the wall change y by inverse_m * (B^T F)_m; the modes left out add residual * F at
/// the touched point alone. A wall without modes stands still or moves as given.
class DuctWall {
 public:
  virtual ~DuctWall() = default;
  virtual const TouchSurface& surface() const = 0;          ///< middle surface now; triangles look outward
  virtual double half_thickness() const = 0;                ///< [m]
  virtual std::span<const double> free_motion() const = 0;  ///< y of the coming step without that body's forces
  virtual std::span<const double> inverse() const = 0;      ///< [1] per mode: change of y per modal force, positive
  /// Rows of the mode shapes at an anchor, into `rows`: row-major 3 x modes [kg^-1/2].
  virtual void rows(const Anchor& anchor, double* rows) const = 0;
  /// [m/N] static compliance of the modes left out, at the anchor; zero where they are not wanted.
  virtual Eigen::Matrix3d residual(const Anchor& anchor) const = 0;
  /// [m] displacement at the anchor that is in surface() and comes from the modes left out, under the last
  /// step's forces. A contact takes it off before it adds its own. Zero where surface() shows the kept modes
  /// alone.
  virtual Eigen::Vector3d residual_motion(const Anchor&) const { return Eigen::Vector3d::Zero(); }
  /// Boundary loops of the tube's open ends: surface node indices in order, each loop once, the duct's own
  /// orientation.
  virtual std::span<const std::vector<int>> mouths() const = 0;
  /// Forces of that body within this step. A wall that moves as given takes no notice.
  virtual void push(std::span<const WallForce> /*forces*/) {}
};

}  // namespace palpate
