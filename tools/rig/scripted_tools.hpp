#pragma once
#include <span>
#include <vector>

#include "common/scene/scene.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {

/// The scripted motions of a scene's tools.
class ScriptedTools {
 public:
  /// Throws std::runtime_error naming a tool that is not scripted, and as load_trajectory() and check_grip() do.
  explicit ScriptedTools(const Scene& scene);

  double duration() const;  ///< [s] of the longest
  /// Where the tools are at a time [s]; valid until the next call.
  std::span<const ToolDofs> at(double time);

 private:
  std::vector<Trajectory> motions_;
  std::vector<ToolDofs> dofs_;
};

}  // namespace palpate
