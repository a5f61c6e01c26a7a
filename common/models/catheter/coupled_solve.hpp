#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/contact/wall.hpp"
#include "common/models/catheter/band_matrix.hpp"
#include "common/models/catheter/touch.hpp"
#include "common/models/catheter/wall_motion.hpp"

namespace palpate {

/// What a tick's solution took.
struct SolveEffort {
  int touches = 0;     ///< looked at
  int passes = 0;      ///< of the active set and the friction
  int iterations = 0;  ///< of conjugate gradients over the wall's modes
  int limited = 0;     ///< particles or steps held back from moving too far in one tick
};

/// Motion D of the catheter's particles, motion y of the wall's modes and the forces between, in one substep.
///
/// They minimise the two bodies' quadratics plus, for each active touch, (overlap left)^2 / 2 (compliance +
/// residual) and the quadratic of its friction. A semi-smooth Newton iteration changes the active set. In
/// each pass D is eliminated by the banded factor of the catheter with all touches' springs in it, and what
/// remains,
///   (I/inverse + B^T (S - S J P^-1 J^T S) B) y = right side,
/// P = A + J^T S J, is solved over the modes by conjugate gradients with the modes' own stiffness as
/// preconditioner. The light catheter stands in series with stiff contacts, so that few iterations do at any
/// contact stiffness; without modes there is none. Each costs as much as particles, and modes times touches.
class CoupledSolve {
 public:
  static constexpr int kMaxPasses = 8;
  static constexpr int kFreePasses = 4;       ///< in which touches may also go
  static constexpr int kFrictionPasses = 3;   ///< in which friction is still adapted
  static constexpr int kMaxIterations = 60;   ///< a pass
  static constexpr double kTolerance = 1e-5;  ///< of the residual against the touches' push on the modes
  static constexpr double kCreep = 1e-3;      ///< [m/s] below it friction is viscous

  CoupledSolve(int particles, const DuctWall* wall, int max_touches);

  /// Begins a tick: no touches, the wall's free motion.
  void begin();
  /// Takes a touch up; those beyond the room are dropped.
  void add(const CatheterTouch& touch);
  std::span<CatheterTouch> touches() { return touches_; }
  std::span<const CatheterTouch> touches() const { return touches_; }

  /// One substep of `h` [s], the first of `of` equal ones for index 0. `base`: matrix of the catheter without
  /// touches; `right_side`: 3 per particle; `velocity` [m/s] at its beginning. May be repeated with more
  /// touches.
  void solve(const BandMatrix& base, std::span<const double> right_side, std::span<const Eigen::Vector3d> velocity,
             double h, int index, int of);
  /// [m] D of the last substep.
  std::span<const Eigen::Vector3d> motion() const;
  /// Takes over a motion that was held back, before advance().
  std::span<Eigen::Vector3d> motion();
  /// Motion of the wall up to the last substep's beginning and up to its end; before advance().
  void show(WallMotion& wall);
  /// Moves the touches' overlaps on by the substep's motion, and adds its share of the forces.
  void advance();
  /// Ends a tick: keeps the wall's answer as the next tick's first guess.
  void end();

  SolveEffort& effort() { return effort_; }
  const SolveEffort& effort() const { return effort_; }
  std::span<double> memory() { return answer_; }  ///< state that goes from tick to tick: one number a mode
  std::span<const double> memory() const { return answer_; }

 private:
  struct Substep {
    double h, share, left;  ///< [s], [1] of the tick, [1] of the tick that is left after it
  };
  double* rows(int touch) { return rows_.data() + static_cast<std::ptrdiff_t>(touch) * 3 * stride_; }
  const double* rows(int touch) const { return rows_.data() + static_cast<std::ptrdiff_t>(touch) * 3 * stride_; }
  Eigen::Vector3d point_motion(const CatheterTouch& touch, const double* d) const;
  Eigen::Vector3d wall_motion(int touch, const double* y) const;
  void add_wall_force(int touch, const Eigen::Vector3d& force, double* modal) const;
  double left_overlap(int touch) const;
  Eigen::Vector3d spring_force(int touch) const;

  void settle();
  void first_guess(std::span<const Eigen::Vector3d> velocity);
  bool eliminate(const BandMatrix& base, std::span<const double> right_side);
  void solve_modes();
  void response(const double* y, double* d, double* modal);
  bool revise(int pass);

  int particles_, modes_, stride_, max_touches_;
  const DuctWall* duct_;
  std::vector<CatheterTouch> touches_;
  std::vector<double> rows_;           ///< per touch 3 x stride_ [kg^-1/2]
  std::vector<double> unpadded_;       ///< 3 x modes_, of one touch
  std::vector<double> stiffness_;      ///< [N/m] per touch, along the normal
  std::vector<double> first_;          ///< [m] per touch: overlap with the tool where the substep ends
  std::vector<double> given_;          ///< [m] per touch: how far the wall has given way along the normal
  std::vector<Eigen::Vector3d> push_;  ///< [N] per touch: on the catheter
  std::vector<Eigen::Vector3d> wall_,
      wall_change_;  ///< [m] per touch: motion of the wall there, and along a direction
  BandMatrix factor_;
  std::vector<double> d_, change_;                   ///< 3 per particle and kBand scratch
  std::vector<double> y_, free_, inverse_, answer_;  ///< per mode, zero up to stride_
  std::vector<double> gone_;                         ///< per mode: motion in this tick up to now
  std::vector<double> residual_, direction_, image_;
  Substep now_{};
  SolveEffort effort_;
};

}  // namespace palpate
