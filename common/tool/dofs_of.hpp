#pragma once
#include "common/tool/pose_values.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// The degrees of freedom that a tool's message holds.
inline ToolDofs dofs_of(const ToolState& s) {
  ToolDofs dofs = dofs_of(pose_values(s), s.pedal);
  dofs.silent = s.silent != 0;
  return dofs;
}

}  // namespace palpate
