#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/describe/state.hpp"
#include "common/models/moving/dynamic_organ.hpp"
#include "common/scene/scene.hpp"
#include "common/sim/tool_playback.hpp"
#include "common/tool/kinematics.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// One tool as moving tissue meets it, followed by the states that its haptic node sends.
class TissueTool {
 public:
  /// `tick` [s]: period of a tick.
  TissueTool(const Tool& tool, double tick);

  /// The newest state; false (and nothing kept) if its pose is no number.
  bool take(const ToolState& state);
  /// Its haptic node has ended: from the next tick on it is gone.
  void leave();
  /// Moves it on by one tick, the world's `number`-th. A tool that falls silent stays where it was, since the network
  /// may have been cut, for two minutes.
  void tick(std::uint64_t number);

  /// In place of a tick: it has come in along its shaft by this share of the depth that its newest state says; what it
  /// holds it takes in the first tick, and there it begins to cut. Nothing, of a tool of which no state has come.
  void enter(double share);

  /// As the organs meet it in this tick. Refers to this object.
  ToolInTick in_tick() const;
  /// The state that the last tick consumed; run 0 before any.
  const ToolState& consumed() const { return consumed_; }
  /// It stands where its newest states say, or nearly: what was missed in a silence has been made up for. A model of
  /// where a tool was long ago is none of where it is.
  bool follows() const;
  bool consumed_anew() const { return anew_; }  ///< by the last tick
  bool has_left() const { return left_; }       ///< in the last tick

  void state(State& s);

 private:
  void turn_jaws();
  void stand();
  void move();

  Trocar trocar_;
  std::vector<ToolPart> parts_, parts_before_;  ///< of jaws they turn
  std::optional<TurningJaws> jaws_;             ///< where they turn
  double period_;                               ///< [s] of a tick, and of a haptic step
  ToolPlayback playback_;
  ToolState newest_, consumed_;
  Eigen::Isometry3d before_ = Eigen::Isometry3d::Identity(), now_ = Eigen::Isometry3d::Identity();
  ToolDofs dofs_;
  double opening_ = 0;  ///< [rad]
  bool holding_ = false, present_ = false, begins_ = false;
  bool waiting_ = false, anew_ = false, leaving_ = false, left_ = false;
  std::uint64_t heard_ = 0;     ///< tick of the last state
  std::uint64_t patience_ = 0;  ///< [ticks] of silence
};

}  // namespace palpate
