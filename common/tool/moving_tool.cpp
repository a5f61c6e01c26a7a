#include "common/tool/moving_tool.hpp"

namespace palpate {

using Eigen::Vector3d;

Segment ToolPart::axis(const Eigen::Isometry3d& tip) const {
  const Vector3d start = tip * pose.translation();
  if (length == 0) return {start, start};
  return {start, start + length * (tip.linear() * pose.linear().col(2))};
}

Segment MovingTool::axis(int part) const {
  return parts[part].axis(now);
}

Segment MovingTool::axis_before(int part) const {
  return parts_before[part].axis(before);
}

Vector3d MovingTool::to_world(int part, const Vector3d& p) const {
  return now * (parts[part].pose * p);
}

Vector3d MovingTool::to_part(int part, const Vector3d& p) const {
  return parts[part].pose.inverse() * (now.inverse() * p);
}

Vector3d MovingTool::to_world_before(int part, const Vector3d& p) const {
  return before * (parts_before[part].pose * p);
}

Vector3d MovingTool::to_part_before(int part, const Vector3d& p) const {
  return parts_before[part].pose.inverse() * (before.inverse() * p);
}

}  // namespace palpate
