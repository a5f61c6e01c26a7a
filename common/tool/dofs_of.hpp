#pragma once
#include "common/tool/kinematics.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// The degrees of freedom that a tool's message holds.
inline ToolDofs dofs_of(const ToolState& s) {
  return {s.yaw, s.pitch, s.depth, s.roll, s.grip, s.pedal, s.silent != 0};
}

}  // namespace palpate
