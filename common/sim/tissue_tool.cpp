#include "common/sim/tissue_tool.hpp"

#include <algorithm>
#include <utility>

#include "common/tool/dofs_of.hpp"
#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

constexpr double kGoneAfter = 120;   // [s] of silence, as the network forgets a participant
constexpr double kMaxBehind = 5e-4;  // [m] by which a tool that follows its states may be behind them

/// [periods] of the haptic loop between two of its states, as their times say: where it stood still or was late, the
/// hand was not. 0 where they say nothing.
double periods_between(const ToolState& before, const ToolState& after, double period) {
  constexpr double most = 1e6;  // a quarter of an hour: what was missed for as long is where the tool is
  const double periods = 1e-9 * (static_cast<double>(after.sense_ns) - static_cast<double>(before.sense_ns)) / period;
  return std::clamp(periods, 0.0, most);
}

}  // namespace

TissueTool::TissueTool(const Tool& tool, double tick)
    : trocar_(make_trocar(tool.pivot, tool.axis, tool.up)),
      parts_(tool_parts(tool)),
      parts_before_(parts_),
      jaws_(abilities_of(tool).turning),
      period_(tick),
      patience_(static_cast<std::uint64_t>(kGoneAfter / tick)) {}

bool TissueTool::take(const ToolState& state) {
  if (!tip_pose(trocar_, dofs_of(state)).matrix().allFinite()) return false;
  newest_ = state;
  waiting_ = true;
  return true;
}

void TissueTool::leave() {
  waiting_ = false;
  leaving_ = present_;
}

void TissueTool::turn_jaws() {
  if (jaws_) set_opening(std::clamp(opening_, 0.0, jaws_->max_open), parts_);
}

void TissueTool::tick(std::uint64_t number) {
  left_ = std::exchange(leaving_, false);
  const bool silent = !waiting_ && heard_ + patience_ < number;
  if (left_ || silent) present_ = false;
  anew_ = std::exchange(waiting_, false);
  begins_ = anew_ && (!present_ || newest_.run != consumed_.run);
  if (begins_)
    playback_.begin(newest_);
  else if (present_)
    playback_.tick(anew_ ? &newest_ : nullptr, anew_ ? periods_between(consumed_, newest_, period_) : 0);
  else
    return stand();
  if (anew_) {
    heard_ = number;
    holding_ = newest_.holding != 0;
    present_ = true;
    consumed_ = newest_;
  }
  move();
}

void TissueTool::stand() {
  before_ = now_;
  parts_before_ = parts_;
}

// To where it is played; one that begins there does not sweep through the tissue on its way.
void TissueTool::move() {
  stand();
  dofs_ = playback_.dofs();
  opening_ = playback_.opening();
  now_ = tip_pose(trocar_, dofs_);
  turn_jaws();
  if (begins_) stand();
}

void TissueTool::enter(double share) {
  if (!waiting_ && !present_) return;
  consumed_ = newest_;
  consumed_.depth *= share;
  playback_.begin(consumed_);
  begins_ = !std::exchange(present_, true);
  move();
}

bool TissueTool::follows() const {
  return playback_.behind() <= kMaxBehind;
}

ToolInTick TissueTool::in_tick() const {
  return {.moving = {before_, now_, parts_before_, parts_},
          .dofs = dofs_,
          .opening = opening_,
          .holding = holding_,
          .present = present_,
          .begins = begins_};
}

void TissueTool::state(State& s) {
  s.value(now_.matrix());
  s.value(dofs_);
  playback_.state(s);
  s.value(opening_);
  s.value(holding_);
  s.value(consumed_);
  s.value(heard_);
  s.value(present_);
  if (s.restoring()) turn_jaws();
}

}  // namespace palpate
