#pragma once
#include <array>
#include <cstdint>

#include "common/describe/state.hpp"
#include "common/tool/kinematics.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// A tool's motion at an even pace, from states that come over a network unevenly: none in one tick, two in the next.
/// Tissue that is stopped and pushed on by turns strikes back, and by one tick's stop already. While none comes the
/// tool goes on as it moved last, for a few steps, and then slower from tick to tick; what was missed for longer is
/// made up for gradually, from the speed that it has then. Of a tissue too slow for its ticks each is worth as many
/// steps as come in one. If one state comes each tick, of a loop in time, it is where that state says, in all bits.
class ToolPlayback {
 public:
  static constexpr int kAhead = 4;  ///< steps for which the motion goes on as it was, or is taken back, without a state
  static constexpr int kFade = 10;  ///< steps that it goes on beyond, in as many ticks to 1/e of its speed
  static constexpr double kMakeUpTicks = 50;  ///< in which all but 1/e of what was missed is made up for
  static constexpr double kUneven = 0.25;  ///< periods by which states may be off their steps and still tell the pace
  static constexpr double kMaxStepsPerTick = 8;  ///< at which a tissue too slow for its ticks follows

  /// The tool stands where this state says.
  void begin(const ToolState& state);
  /// A tick in which a newer state of the same run came, so many periods of its loop after the last one (0: as many as
  /// steps), or none did (null).
  void tick(const ToolState* arrived, double periods = 0);

  ToolDofs dofs() const;
  double opening() const { return now_[5]; }  ///< [rad] of a forceps' jaws
  /// [m] at most by which the tip is behind where the states say, since none came for long: what is made up for now.
  double behind() const;

  void state(State& s);

 private:
  using Values = std::array<double, 6>;  ///< yaw, pitch, depth, roll, grip, opening
  static Values values(const ToolState& state);
  Values place(double along) const;
  double steps_in_tick(std::uint64_t arrived);
  void make_up();
  void take(const ToolState& arrived, double came, double periods, double steps_now);

  Values newest_{}, pace_{};  ///< of the newest state; change from one step to the next
  Values missed_{};           ///< from what the states say to where the tool still is
  Values drift_{};            ///< change of that in a tick
  Values now_{};
  std::uint64_t step_ = 0;     ///< of the newest state
  double along_ = 0;           ///< steps from the newest state to what is played
  double steps_per_tick_ = 1;  ///< that came in the ticks of late
  double pedal_ = 0;
};

}  // namespace palpate
