#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "common/models/catheter/coupled_solve.hpp"
#include "common/models/catheter/grasps.hpp"

namespace palpate {

/// A rounded part of a tool that the catheter may touch: shaft or jaw of a forceps.
struct CatheterTool {
  int tool = 0;
  int part = 0;
  std::array<Eigen::Vector3d, 2> before, now;  ///< [m] world: ends of its axis at begin and end of the tick
  double radius = 0;                           ///< [m]
  double compliance = 1e-4;                    ///< [m/N]
  double friction = 0.3;                       ///< [1]
};

/// Touches between the tools' parts and the catheter's segments. Each pair keeps the side on which it met, so
/// that a tool that is forced through still pushes back; it forgets beyond three radii.
class ToolTouches {
 public:
  ToolTouches(int segments, int max_parts);

  /// Finds the coming tick's touches. A tool that holds the catheter does not touch it where it holds.
  void find(std::span<const CatheterTool> tools, std::span<const Eigen::Vector3d> x, double radius,
            const Grasps& grasps, CoupledSolve& solve);
  /// Keeps the forces for the next tick's friction.
  void keep(std::span<const CatheterTouch> touches);

  struct Pair {
    Eigen::Vector3d side = Eigen::Vector3d::Zero();  ///< unit, from tool to catheter; zero: apart
    double normal_force = 0;                         ///< [N] of the last tick
  };
  std::span<Pair> pairs() { return pairs_; }
  std::span<const Pair> pairs() const { return pairs_; }

 private:
  void meet(const CatheterTool& tool, int part, int segment, std::span<const Eigen::Vector3d> x, double radius,
            CoupledSolve& solve);
  Pair& pair(int part, int segment) { return pairs_[part * segments_ + segment]; }

  int segments_, max_parts_;
  std::vector<Pair> pairs_;
};

}  // namespace palpate
