#pragma once
#include <functional>
#include <span>
#include <vector>

#include "common/contact/cut_surface.hpp"
#include "common/describe/state.hpp"
#include "common/models/moving/tool_in_tick.hpp"

namespace palpate {

/// What a tool does to a body in a tick.
struct ToolDeed {
  bool holds;  ///< its jaws hold some of it
  bool glows;  ///< it cuts
};

/// Which tools pass through an organ's tissue: one that began glowing, near tissue that had been cut, or run through
/// what is whole, as where a cut was missed. Neither feels the other until the tool glows no more and has been
/// withdrawn by a centimetre, or its jaws take hold.
class PassingTools {
 public:
  /// The surface outlives this object.
  PassingTools(const CutSurface& surface, std::size_t tools) : surface_(surface), passing_(tools, 0) {}

  bool passes(int tool) const { return passing_[tool] != 0; }
  /// Once a tick; `cut`: tissue has gone. Tissue that is whole can be pressed to where a tool begins; between the flaps
  /// of a cut nobody knows what is on which side of it, nor, where forceps drew them apart, do they lie as they did; of
  /// a stroke that goes on nobody knows what the last ticks should have cut.
  void meet(std::span<const ToolInTick> tools, bool cut, const std::function<ToolDeed(int tool)>& deed);
  /// After meet(): those that are withdrawn pass no more.
  void clear(std::span<const ToolInTick> tools, const std::function<ToolDeed(int tool)>& deed);

  void state(State& s) {
    s.same(passing_.size());
    s.all(passing_);
  }

 private:
  bool runs_through(const MovingTool& tool) const;
  bool is_near(const MovingTool& tool) const;

  const CutSurface& surface_;
  std::vector<char> passing_;  ///< per tool
};

}  // namespace palpate
