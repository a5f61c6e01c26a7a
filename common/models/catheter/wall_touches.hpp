#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "common/models/catheter/coupled_solve.hpp"
#include "common/models/catheter/lumen.hpp"
#include "common/models/catheter/wall_motion.hpp"

namespace palpate {

/// Touches between particles and the duct's wall by a sphere of influence: radius plus half the wall's
/// thickness about each particle against the middle surface. A particle in the lumen is pushed off the inner
/// side, one outside off the outer side or the rim, also when it has passed through. At most two each: the
/// nearest point of the wall, and the nearest that faces the particle from a clearly different side.
class WallTouches {
 public:
  static constexpr double kCompliance = 2e-5;  ///< [m/N] of a particle's contact
  static constexpr double kLedBack = 0.3;  ///< of the reach: by how much a particle found deeper is led back in a tick
  static constexpr double kStiffening = 20;  ///< [1] the contact is so much stiffer beyond that depth

  WallTouches(int particles, const DuctWall* wall, double radius, double friction);

  /// Finds the coming tick's touches, `h` [s] ahead.
  void find(std::span<const Eigen::Vector3d> x, std::span<const Eigen::Vector3d> v, double h, Lumen& lumen,
            CoupledSolve& solve);
  /// Where a particle on its way to x + motion would pass through the wall, which moves by wall_motion(), from
  /// the side on which it must stay. One that moves little by a wall that does meets what find() has found.
  struct Passage {
    double time;             ///< in [0, 1]
    CatheterTouch touch;     ///< that keeps it back
    Eigen::Vector3d before;  ///< [m] world: close before the place where it meets the wall, when that has moved
  };
  std::optional<Passage> passage(int particle, const Eigen::Vector3d& x, const Eigen::Vector3d& motion,
                                 const Lumen& lumen);
  WallMotion& wall_motion() { return wall_motion_; }
  /// Keeps the forces for the next tick's friction.
  void keep(std::span<const CatheterTouch> touches);

  double reach() const { return reach_; }  ///< [m]

  struct Past {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double normal_force = 0;  ///< [N] of the last tick
  };
  std::span<std::array<Past, 2>> past() { return past_; }
  std::span<const std::array<Past, 2>> past() const { return past_; }

 private:
  struct Plane {  ///< of a triangle nearby
    int triangle;
    Eigen::Vector3d normal;  ///< outward
    double square;           ///< of its length
  };
  struct Near {
    int triangle = -1;
    Eigen::Vector3d weights = Eigen::Vector3d::Zero(),
                    q = Eigen::Vector3d::Zero();        ///< the triangle's nearest point
    Eigen::Vector3d outward = Eigen::Vector3d::Zero();  ///< unit normal of the triangle
    double distance = 0, facing = 0;                    ///< [m]; [m] along the normal, outside positive
  };
  static ClosestPoint closest(const Eigen::Vector3d& x, const Triangle& c, const Eigen::Vector3d& normal,
                              double square);
  bool find_nearest(const Eigen::Vector3d& x, std::span<const int> triangles, double within, Near& best);
  bool find_opposite(const Eigen::Vector3d& x, const Eigen::Vector3d& normal, double side, double within,
                     Near& best) const;
  Near nearest_on(const Plane& plane, const Eigen::Vector3d& x) const;
  double direction(int particle, const Eigen::Vector3d& x, const Near& near, Lumen& lumen, Eigen::Vector3d& normal,
                   double& distance) const;
  CatheterTouch touch_at(int particle, const Near& near, const Eigen::Vector3d& normal, double distance) const;
  double past_force(int particle, const Eigen::Vector3d& normal) const;

  const DuctWall* wall_;
  WallMotion wall_motion_;
  double friction_, reach_ = 0, margin_ = 0;
  double travel_ = 0;  ///< [m] by which the wall may move in this tick
  std::vector<std::array<Past, 2>> past_;
  std::vector<Plane> planes_;  ///< about the particle in hand
};

}  // namespace palpate
