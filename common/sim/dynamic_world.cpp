#include "common/sim/dynamic_world.hpp"

#include <algorithm>
#include <utility>

#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

constexpr double kGoneAfter = 120;   // [s] of silence, as the network forgets a participant
constexpr double kMaxBehind = 5e-4;  // [m] by which a tool that follows its states may be behind them

// Settling, in ticks: under the tissue's own weight, while tools enter, and until what they press has come to rest.
constexpr int kRestTicks = 400, kEnterTicks = 300, kCalmTicks = 300;

ToolDofs dofs_of(const ToolState& s) {
  return {s.yaw, s.pitch, s.depth, s.roll, s.grip, s.pedal};
}

}  // namespace

DynamicWorld::DynamicWorld(const Scene& scene, const std::vector<Archive>& archives)
    : dt_(1.0 / scene.rates.haptic_hz),
      tools_(scene.tools.size()),
      playback_(scene.tools.size()),
      newest_(scene.tools.size()),
      consumed_(scene.tools.size()),
      waiting_(scene.tools.size(), 0),
      anew_(scene.tools.size(), 0),
      leaving_(scene.tools.size(), 0),
      left_(scene.tools.size(), 0),
      heard_(scene.tools.size(), 0) {
  for (const Tool& tool : scene.tools) {
    trocars_.push_back(make_trocar(tool.pivot, tool.axis, tool.up));
    parts_.push_back(tool_parts(tool));
    jaws_.push_back(abilities_of(tool).turning);
  }
  parts_before_ = parts_;
  for (std::size_t t = 0; t < tools_.size(); ++t) {
    tools_[t].moving.parts = parts_[t];
    tools_[t].moving.parts_before = parts_before_[t];
  }
  const StepSettings settings{scene.contact, scene.tools, dt_};
  for (int b = 0; b < static_cast<int>(scene.bodies.size()); ++b) {
    const auto make = [&](const auto& spec) { return make_organ(spec, archives[b], settings); };
    auto organ = std::visit(make, scene.bodies[b]);
    if (!organ) continue;
    organs_.push_back(std::move(organ));
    body_of_.push_back(b);
  }
}

bool DynamicWorld::take(const ToolState& state) {
  if (state.tool >= tools_.size() || !tip_pose(trocars_[state.tool], dofs_of(state)).matrix().allFinite()) return false;
  newest_[state.tool] = state;
  waiting_[state.tool] = 1;
  return true;
}

bool DynamicWorld::follows(int t) const {
  return playback_[t].behind() <= kMaxBehind;
}

void DynamicWorld::leave(int tool) {
  waiting_[tool] = 0;
  leaving_[tool] = tools_[tool].present;
}

void DynamicWorld::drop_absent() {
  const auto patience = static_cast<std::uint64_t>(kGoneAfter / dt_);
  for (int t = 0; t < tools(); ++t) {
    left_[t] = std::exchange(leaving_[t], 0);
    const bool silent = !waiting_[t] && heard_[t] + patience < ticks_;
    if (left_[t] || silent) tools_[t].present = false;
  }
}

void DynamicWorld::turn_jaws(int t) {
  if (jaws_[t]) set_opening(std::clamp(tools_[t].opening, 0.0, jaws_[t]->max_open), parts_[t]);
}

void DynamicWorld::move(int t) {
  ToolInTick& tool = tools_[t];
  tool.moving.before = tool.moving.now;
  parts_before_[t] = parts_[t];
  anew_[t] = std::exchange(waiting_[t], 0);
  const ToolState& newest = newest_[t];
  // A tool that comes anew, or of another run, does not sweep through the tissue on its way here.
  const bool begins = anew_[t] && (!tool.present || newest.run != consumed_[t].run);
  if (begins)
    playback_[t].begin(newest);
  else if (tool.present)
    playback_[t].tick(anew_[t] ? &newest : nullptr);
  else
    return;
  if (anew_[t]) {
    heard_[t] = ticks_;
    tool.holding = newest.holding != 0;
    tool.present = true;
    consumed_[t] = newest;
  }
  tool.dofs = playback_[t].dofs();
  tool.opening = playback_[t].opening();
  tool.moving.now = tip_pose(trocars_[t], tool.dofs);
  turn_jaws(t);
  if (!begins) return;
  tool.moving.before = tool.moving.now;
  parts_before_[t] = parts_[t];
}

void DynamicWorld::tick() {
  drop_absent();
  if (ticks_ % keyframe_interval() == 0)
    for (auto& organ : organs_) organ->forget_factors();
  for (int t = 0; t < tools(); ++t) move(t);
  for (auto& organ : organs_) organ->tick(tools_, dt_);
  ++ticks_;
}

// A tool that has come in by this share of its depth; what it holds it takes in the first tick.
void DynamicWorld::enter(int t, double share) {
  ToolInTick& tool = tools_[t];
  consumed_[t] = newest_[t];
  consumed_[t].depth *= share;
  playback_[t].begin(consumed_[t]);
  tool.dofs = playback_[t].dofs();
  tool.opening = playback_[t].opening();
  tool.moving.before = tool.moving.now;
  parts_before_[t] = parts_[t];
  tool.moving.now = tip_pose(trocars_[t], tool.dofs);
  turn_jaws(t);
  if (tool.present) return;
  tool.moving.before = tool.moving.now;
  parts_before_[t] = parts_[t];
  tool.present = true;
}

bool DynamicWorld::settle() {
  const int entering = settled_ - kRestTicks;
  // Fast through free space, slowly at the end, where it meets the tissue.
  const double left = std::clamp(1 - static_cast<double>(entering) / kEnterTicks, 0.0, 1.0);
  for (int t = 0; t < tools(); ++t)
    if (entering >= 0 && (waiting_[t] || tools_[t].present)) enter(t, 1 - left * left);
  for (auto& organ : organs_) {
    organ->tick(tools_, dt_);
    organ->calm();
  }
  return ++settled_ >= kRestTicks + kEnterTicks + kCalmTicks;
}

void DynamicWorld::state(State& s) {
  s.value(ticks_);
  std::vector<MovingTool> moving;
  for (int t = 0; t < tools(); ++t) {
    ToolInTick& tool = tools_[t];
    s.value(tool.moving.now.matrix());
    s.value(tool.dofs);
    playback_[t].state(s);
    s.value(tool.opening);
    s.value(tool.holding);
    s.value(consumed_[t]);
    s.value(heard_[t]);
    s.value(tool.present);
    if (s.restoring()) turn_jaws(t);
    moving.push_back(tool.moving);
  }
  for (auto& organ : organs_) organ->state(s, moving);
}

std::vector<std::uint8_t> DynamicWorld::save() const {
  std::vector<std::uint8_t> bytes;
  State s = State::save(bytes);
  const_cast<DynamicWorld*>(this)->state(s);
  return bytes;
}

void DynamicWorld::restore(std::span<const std::uint8_t> from) {
  State s = State::restore(from);
  state(s);
  if (s.size() != from.size()) throw std::runtime_error("the recorded state is of another scene");
}

std::uint64_t DynamicWorld::hash() const {
  std::uint64_t hash = 0;
  for (const auto& organ : organs_) hash = hash * 31 + organ->hash();
  return hash;
}

}  // namespace palpate
