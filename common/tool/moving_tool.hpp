#pragma once
#include <span>

#include "common/tool/tool_part.hpp"

namespace palpate {

/// A tool as the contact search sees it: two poses of its tip frame and its parts in both. Jaws turn within the tip
/// frame, so their parts differ; a rigid tool's two spans may be one.
struct MovingTool {
  Eigen::Isometry3d before = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d now = Eigen::Isometry3d::Identity();
  std::span<const ToolPart> parts_before, parts;  ///< equally many

  int size() const { return static_cast<int>(parts.size()); }
  double radius(int part) const { return parts[part].radius; }
  Segment axis(int part) const;
  Segment axis_before(int part) const;

  /// Between the world and a part's own frame now: what sticks to a jaw turns with it.
  Eigen::Vector3d to_world(int part, const Eigen::Vector3d& p) const;
  Eigen::Vector3d to_part(int part, const Eigen::Vector3d& p) const;
  /// The same for the poses before.
  Eigen::Vector3d to_world_before(int part, const Eigen::Vector3d& p) const;
  Eigen::Vector3d to_part_before(int part, const Eigen::Vector3d& p) const;
};

}  // namespace palpate
