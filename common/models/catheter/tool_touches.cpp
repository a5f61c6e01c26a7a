#include "common/models/catheter/tool_touches.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/segment.hpp"

namespace palpate {

using Eigen::Vector3d;

namespace {

constexpr double kLookedAt = 1.5;   ///< of both radii: pairs nearer than this are taken up
constexpr double kForgotten = 3.0;  ///< of both radii: a tool farther on the wrong side has passed

/// From the tool's axis before the tick to the catheter, where the pair has not met yet.
Vector3d first_side(const Segment& before, const Segment& piece) {
  const ClosestOfSegments c = closest_points(before, piece);
  const Vector3d apart = piece.at(c.share_b) - before.at(c.share_a);
  if (apart.squaredNorm() > 0) return apart.normalized();
  const Vector3d across = (before.end - before.start).cross(piece.end - piece.start);
  return across.squaredNorm() > 0 ? across.normalized() : (piece.end - piece.start).unitOrthogonal();
}

}  // namespace

ToolTouches::ToolTouches(int segments, int max_parts)
    : segments_(segments), max_parts_(max_parts), pairs_(static_cast<std::size_t>(segments) * max_parts) {}

void ToolTouches::find(std::span<const CatheterTool> tools, std::span<const Vector3d> x, double radius,
                       const Grasps& grasps, CoupledSolve& solve) {
  for (int part = 0; part < max_parts_; ++part) {
    const bool given = part < static_cast<int>(tools.size());
    for (int segment = 0; segment < segments_; ++segment) {
      if (!given || grasps.holds_near(tools[part].tool, segment)) {
        pair(part, segment) = {};
        continue;
      }
      meet(tools[part], part, segment, x, radius, solve);
    }
  }
}

void ToolTouches::meet(const CatheterTool& tool, int part, int segment, std::span<const Vector3d> x, double radius,
                       CoupledSolve& solve) {
  Pair& pair = this->pair(part, segment);
  const Segment now{tool.now[0], tool.now[1]}, before{tool.before[0], tool.before[1]},
      piece{x[segment], x[segment + 1]};
  const double both = tool.radius + radius, far = kForgotten * both;
  // Quickly past the many that are far apart.
  const Vector3d low = piece.start.cwiseMin(piece.end), high = piece.start.cwiseMax(piece.end);
  const Vector3d tool_low = now.start.cwiseMin(now.end).cwiseMin(before.start).cwiseMin(before.end);
  const Vector3d tool_high = now.start.cwiseMax(now.end).cwiseMax(before.start).cwiseMax(before.end);
  if ((low - tool_high).maxCoeff() > far || (tool_low - high).maxCoeff() > far) {
    pair = {};
    return;
  }
  const ClosestOfSegments c = closest_points(now, piece);
  const Vector3d apart = piece.at(c.share_b) - now.at(c.share_a);
  const double distance = std::sqrt(c.squared_distance),
               step = (now.start - before.start).norm() + (now.end - before.end).norm();
  const bool met = pair.side != Vector3d::Zero();
  if (distance > (met ? far : kLookedAt * both + step)) {
    pair = {};
    return;
  }
  if (!met) pair.side = first_side(before, piece);
  const double sign = apart.dot(pair.side) >= 0 ? 1 : -1;
  if (sign > 0 && distance > kLookedAt * both + step) {
    pair = {};
    return;
  }
  if (distance > 1e-3 * both) pair.side = apart * (sign / distance);
  if (c.share_b == 0 && segment > 0) return;  // the segment before it ends there
  CatheterTouch touch;
  touch.point = {segment, c.share_b};
  touch.normal = pair.side;
  touch.overlap = both - sign * distance;
  touch.compliance = tool.compliance;
  touch.friction = tool.friction;
  touch.grip = tool.friction * pair.normal_force;
  touch.carried = now.at(c.share_a) - before.at(c.share_a);
  touch.part = part;
  touch.at = now.at(c.share_a) + tool.radius * pair.side;
  solve.add(touch);
}

void ToolTouches::keep(std::span<const CatheterTouch> touches) {
  for (Pair& pair : pairs_) pair.normal_force = 0;
  for (const CatheterTouch& t : touches)
    if (!t.on_wall) pair(t.part, t.point.segment).normal_force += std::max(0.0, t.normal_force);
}

}  // namespace palpate
