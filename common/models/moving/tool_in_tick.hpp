#pragma once
#include "common/tool/kinematics.hpp"
#include "common/tool/moving_tool.hpp"

namespace palpate {

/// One tool as an organ meets it within a tick.
struct ToolInTick {
  MovingTool moving;
  ToolDofs dofs;
  double opening = 0;    ///< [rad] between a forceps' jaws
  bool holding = false;  ///< its jaws are shut on what is between them
  bool present = false;  ///< its pose is known
  bool begins = false;   ///< no motion has led it to where it is: it has come anew, or its haptic node has
};

}  // namespace palpate
