#pragma once
#include "common/models/moving/dynamic_organ.hpp"
#include "tools/study/measure.hpp"
#include "tools/study/solid_case.hpp"

namespace palpate::study {

/// Presses moving tissue with a ball through the deformation node's own organ, tick by tick.
class OrganPress {
 public:
  /// `scene`: one body, one tool, as SolidCase::press_scene() makes it; outlives this object as `archive`.
  OrganPress(const Scene& scene, const Archive& archive, const Patch& patch, double radius, double tick);

  /// One tick, at whose end the ball is at `depth` [m]; force along the press on the tissue [N].
  double tick(double depth);
  /// Ticks on the spot until force and shape have settled to a ten-thousandth within 50 ms, or `seconds` have
  /// passed. Returns the force.
  double settle(double seconds);
  std::vector<Eigen::Vector3d> displacement() const;  ///< [m] per node of the archive's surface map
  double at(const std::array<int, 3>& nodes) const;   ///< [m] mean displacement of three nodes along the press
  const DynamicOrgan& organ() const { return organ_; }
  double depth() const { return depth_; }
  std::size_t bytes() const { return bytes_; }

 private:
  Eigen::Vector3d node_displacement(int node) const;

  const Archive& archive_;
  Patch patch_;
  double radius_, tick_, depth_;
  std::vector<ToolPart> parts_;
  std::size_t before_;
  DynamicOrgan organ_;
  std::size_t bytes_;
  Trocar trocar_;
  ToolInTick tool_;
};

}  // namespace palpate::study
