#pragma once
#include "common/tool/kinematics.hpp"
#include "common/tool/spec.hpp"

namespace palpate {

/// The degrees of freedom that put the centre of a tool's tip at p [m].
inline ToolDofs tip_at(const Tool& tool, const Eigen::Vector3d& p, double roll = 0) {
  return dofs_for_tip(make_trocar(tool.pivot, tool.axis, tool.up), p, roll);
}

}  // namespace palpate
