#pragma once
#include <functional>
#include <span>
#include <vector>

#include "common/contact/cut_surface.hpp"
#include "common/describe/state.hpp"
#include "common/models/moving/tool_in_tick.hpp"

namespace palpate {

/// Which tools pass through an organ's tissue: one that began run through it, as where a cut was missed, or touching
/// tissue that had been cut. Neither feels the other until they are clear of one another, or its jaws take hold.
class PassingTools {
 public:
  /// The surface outlives this object.
  PassingTools(const CutSurface& surface, std::size_t tools) : surface_(surface), passing_(tools, 0) {}

  bool passes(int tool) const { return passing_[tool] != 0; }
  /// Once a tick; `cut`: tissue has gone. Tissue that is whole can be pressed to where a tool begins; between the flaps
  /// of a cut nobody knows what is on which side of it. `holds`: whether a tool's jaws hold the body.
  void meet(std::span<const ToolInTick> tools, bool cut, const std::function<bool(int tool)>& holds);
  /// After meet(): those that are clear pass no more.
  void clear(std::span<const ToolInTick> tools, const std::function<bool(int tool)>& holds);

  void state(State& s) { s.list(passing_); }
  bool fits(std::size_t tools) const { return passing_.size() == tools; }  ///< of what was restored

 private:
  bool runs_through(const MovingTool& tool) const;
  bool touches(const MovingTool& tool) const;

  const CutSurface& surface_;
  std::vector<char> passing_;  ///< per tool
};

}  // namespace palpate
