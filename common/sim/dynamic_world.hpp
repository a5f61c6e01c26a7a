#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/models/moving/dynamic_organ.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/tissue_tool.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// All dynamic bodies of a scene with the tools that move among them: what the deformation node owns and advances. A
/// tick is a function of the tools' newest states and of the world's own state.
class DynamicWorld {
 public:
  /// One archive per body of the scene; those of quasi-static bodies are not looked at.
  DynamicWorld(const Scene& scene, const std::vector<Archive>& archives);

  double dt() const { return dt_; }  ///< [s] nominal period of a tick: that of the haptic loop
  /// Ticks from one keyframe to the next: a second.
  std::uint64_t keyframe_interval() const { return static_cast<std::uint64_t>(std::lround(1 / dt_)); }
  int tools() const { return static_cast<int>(tools_.size()); }
  std::span<const int> bodies() const { return body_of_; }  ///< the dynamic ones
  const DynamicOrgan& organ(int i) const { return *organs_[i]; }
  DynamicOrgan& organ(int i) { return *organs_[i]; }
  int organs() const { return static_cast<int>(organs_.size()); }

  /// The newest state of a tool; false (and nothing kept) if the scene has no such tool or the pose is no number.
  bool take(const ToolState& state);
  /// The tool's haptic node has ended: from the next tick on it is gone, with what it held.
  void leave(int tool);
  /// Moves everything on by dt().
  void tick();

  /// Before the first tick, in a node that comes when tools are in the tissue already: one tick's length of coming to
  /// rest, first under the tissue's own weight, then with the tools. These enter whole tissue along their shafts to
  /// where their newest states say; where they would run through it, or something has been cut, they are there at once,
  /// and pass through it (DynamicOrgan::passes). They cut nothing on their way; what they tear is gone. True when it is
  /// over; call until then, after taking the newest states.
  bool settle();

  std::uint64_t ticks() const { return ticks_; }
  /// [ns] of the tissue's own time.
  std::int64_t time_ns() const { return std::llround(1e9 * static_cast<double>(ticks_) * dt_); }
  const TissueTool& tool(int t) const { return tools_[t]; }
  const ToolInTick& in_tick(int t) const { return in_tick_[t]; }  ///< as the organs met it in the last tick

  std::vector<std::uint8_t> save() const;
  void restore(std::span<const std::uint8_t> from);
  void state(State& s);
  std::uint64_t hash() const;

 private:
  void see_tools();
  void meet_tools();
  bool presses(int tool) const;

  double dt_;
  std::vector<TissueTool> tools_;
  std::vector<ToolInTick> in_tick_;  ///< the same tools as the organs meet them
  std::vector<std::unique_ptr<DynamicOrgan>> organs_;
  std::vector<int> body_of_;
  std::uint64_t ticks_ = 0;
  int settled_ = 0;  ///< ticks of settling
};

}  // namespace palpate
