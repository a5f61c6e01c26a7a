#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "common/contact/wall.hpp"
#include "common/describe/state.hpp"
#include "common/models/catheter/chain.hpp"
#include "common/models/catheter/coupled_solve.hpp"
#include "common/models/catheter/grasps.hpp"
#include "common/models/catheter/lumen.hpp"
#include "common/models/catheter/sleeve.hpp"
#include "common/models/catheter/spec.hpp"
#include "common/models/catheter/tool_touches.hpp"
#include "common/models/catheter/wall_touches.hpp"

namespace palpate {

/// What a catheter is made from.
struct CatheterSettings {
  Catheter shape;         ///< the scene's
  double young = 0;       ///< [Pa]
  double density = 1000;  ///< [kg/m^3]
  double step = 1e-3;     ///< [s] of a tick
  double friction = 0.3;  ///< [1] against the wall
  int max_parts = 12;     ///< tool parts that one step meets at most
  int max_tools = 4;      ///< tools that may hold it, numbered from 0
};

/// A force between the catheter and a tool.
struct CatheterToolForce {
  int tool = 0;
  int part = 0;                                     ///< as in CatheterTool; -1: the tool holds the catheter there
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< [m] world
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< [N] on the catheter
};

/// A flexible catheter that moves freely, through a sleeve, in a duct, under tools and held by them.
///
/// One tick, `implicit`: linearised backward Euler in the motion D = h v_{t+h},
///   (M/h^2 + damping M/h + K) D = f(x) + M v/h,
/// together with the wall's modes and all contacts, which are springs on one side (coupled_solve.hpp): stable
/// for any stiffness. `semi_implicit`: BHS01 eq. 28 in substeps, the contacts implicit as before.
///
/// Everything is deterministic; nothing is allocated after construction.
class CatheterBody : public Stateful<CatheterBody> {
 public:
  /// `wall`: the duct that it is led into, nullptr for none; outlives the catheter. Throws std::runtime_error
  /// in words: bad numbers, a catheter wider than the duct, a stiffness that semi_implicit would need more
  /// than 64 substeps for.
  CatheterBody(const CatheterSettings& settings, const DuctWall* wall);

  /// One tick. `tools`: every part of every tool that may touch; the order of parts stays the same from tick
  /// to tick. `jaws`: per tool number the jaw's frame at the end of the tick; empty where nothing is held.
  void step(std::span<const CatheterTool> tools, std::span<const Eigen::Isometry3d> jaws);

  int size() const { return chain_.size(); }
  double spacing() const { return chain_.spacing(); }                 ///< [m] between particles at rest
  double radius() const { return radius_; }                           ///< [m]
  std::span<const Eigen::Vector3d> positions() const { return x_; }   ///< [m] from tail to tip
  std::span<const Eigen::Vector3d> velocities() const { return v_; }  ///< [m/s]
  std::span<const char> inside() const {
    return lumen_.inside();
  }                                           ///< per particle: in the lumen; empty without a wall
  int substeps() const { return substeps_; }  ///< per tick

  // What the last tick brought.
  std::span<const WallForce> wall_forces() const { return wall_forces_; }
  std::span<const CatheterToolForce> tool_forces() const { return tool_forces_; }  ///< contacts and grasps
  int wall_contacts() const { return static_cast<int>(wall_forces_.size()); }      ///< particles' touches of the wall
  const SolveEffort& effort() const { return solve_.effort(); }

  // Grasping.
  /// The point of the centre line nearest to p.
  ChainPoint nearest(const Eigen::Vector3d& p) const;
  Eigen::Vector3d place(const ChainPoint& point) const;
  /// Particles within `radius` of a centre, in order, into `found`; returns how many.
  int points_near(const Eigen::Vector3d& centre, double radius, std::span<Eigen::Vector3d> found) const;
  /// The tool holds the catheter from now on at `point`, and with a length [m] also half of it to both sides,
  /// each place where it now is in the jaw's frame, by springs of 1/compliance [N/m]. A tool that already
  /// holds lets go first.
  void grasp(int tool, const Eigen::Isometry3d& jaw, const ChainPoint& point, double length, double compliance);
  void let_go(int tool) { grasps_.let_go(tool); }
  bool holds(int tool) const { return grasps_.holds(tool); }
  double load(int tool) const {
    return grasps_.load(tool);
  }  ///< [N] size of the force by which it held in the last tick

  /// [m] length of the catheter in the lumen, its segments through a mouth counted in part.
  double inserted() const;
  double energy() const;  ///< [J] kinetic, elastic and of gravity (against the rest position); springs of
                          ///< contacts left out

  /// Everything that the next step depends on, apart from wall and tools.
  void state(State& s);

 private:
  static int max_touches(int particles, int parts);
  void follow_restored();
  void substep(int index);
  void assemble(double h, double left);
  bool note_tension(double h);
  bool close_passages();
  void keep_together();
  void hold_back();
  void collect_forces(std::span<const CatheterTool> tools);

  Chain chain_;
  double radius_, step_, damping_;
  Eigen::Vector3d gravity_;
  bool implicit_;
  int substeps_ = 1;
  const DuctWall* wall_;
  Lumen lumen_;
  Sleeve sleeve_;
  Grasps grasps_;
  WallTouches wall_touches_;
  ToolTouches tool_touches_;
  CoupledSolve solve_;

  std::vector<Eigen::Vector3d> x_, v_, before_;  ///< before_: at the tick's beginning
  std::vector<Eigen::Vector3d> force_;
  std::vector<double> tension_;  ///< [N] of each segment at the end of the last tick
  BandMatrix base_;
  std::vector<double> right_side_;
  std::vector<WallForce> wall_forces_;
  std::vector<CatheterToolForce> tool_forces_;
};

}  // namespace palpate
