#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "common/models/catheter/band_matrix.hpp"
#include "common/models/catheter/touch.hpp"

namespace palpate {

/// Places of the catheter held by tools: material points tied by springs to places in the jaws' frames.
class Grasps {
 public:
  static constexpr int kMaxPoints = 3;  ///< per tool

  struct Held {
    ChainPoint point;
    Eigen::Vector3d in_jaw = Eigen::Vector3d::Zero();  ///< [m] place in the jaw's frame
    Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< [m] world, at the end of the last tick
    Eigen::Vector3d next = Eigen::Vector3d::Zero();    ///< [m] world, at the end of this one
    Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< [N] on the catheter, mean over the tick
  };
  struct Grasp {
    int count = 0;
    double stiffness = 0;  ///< [N/m] of each point's spring
    std::array<Held, kMaxPoints> held;
  };

  explicit Grasps(int max_tools) : grasps_(max_tools) {}

  bool holds(int tool) const { return tool >= 0 && tool < tools() && grasps_[tool].count > 0; }
  /// Whether the tool holds the catheter at this segment or beside it.
  bool holds_near(int tool, int segment) const;
  void take(int tool, double stiffness) { grasps_.at(tool) = {.count = 0, .stiffness = stiffness, .held = {}}; }
  void add(int tool, const ChainPoint& point, const Eigen::Vector3d& place, const Eigen::Isometry3d& jaw);
  void let_go(int tool);
  double load(int tool) const;

  int tools() const { return static_cast<int>(grasps_.size()); }
  const Grasp& of(int tool) const { return grasps_[tool]; }

  /// Targets of the coming tick; a tool without a frame keeps its place.
  void begin(std::span<const Eigen::Isometry3d> jaws);
  /// Adds the springs at the end of a substep, `left` of the tick being left after it.
  void add_springs(std::span<const Eigen::Vector3d> x, double left, BandMatrix& matrix,
                   std::span<double> right_side) const;
  /// Adds the substep's share of the forces, at its end positions.
  void add_forces(std::span<const Eigen::Vector3d> x, double left, double share);
  void end();

  std::span<Grasp> all() { return grasps_; }
  std::span<const Grasp> all() const { return grasps_; }

 private:
  std::vector<Grasp> grasps_;
};

/// Place of a material point.
inline Eigen::Vector3d place_of(const ChainPoint& p, std::span<const Eigen::Vector3d> x) {
  return (1 - p.along) * x[p.segment] + p.along * x[p.segment + 1];
}

/// Adds `block` acting between the material point and itself to the chain's matrix.
void add_at_point(const ChainPoint& p, const Eigen::Matrix3d& block, BandMatrix& matrix);
/// Adds a force at the material point to `right_side`, three entries per particle.
void add_at_point(const ChainPoint& p, const Eigen::Vector3d& force, std::span<double> right_side);

}  // namespace palpate
