#pragma once
#include <Eigen/Core>
#include <variant>

#include "common/describe/state.hpp"
#include "common/geometry/anchor.hpp"

namespace palpate {

/// A point of a tool's part. It goes where the hand takes the tool.
struct ToolPoint {
  int tool = 0;
  int part = 0;                                      ///< which part of the tool
  double softness = 0;                               ///< [m/N] by which what holds the point gives way to the force,
                                                     ///< and the tissue there beyond what its nodes do
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< [m] in the part's own frame; of jaws' hold, in the tip frame
};

/// What is remembered of one from step to step; its softness is the scene's.
inline void state(State& s, ToolPoint& point) {
  s.value(point.tool);
  s.value(point.part);
  s.value(point.offset);
}

/// What presses in a contact: a point of a tool, or a material point of another body's surface, which gives way as that
/// body does.
using ContactSide = std::variant<ToolPoint, Anchor>;

}  // namespace palpate
