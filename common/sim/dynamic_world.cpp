#include "common/sim/dynamic_world.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace palpate {
namespace {

// Settling, in ticks: under the tissue's own weight, while tools enter, and until what they press has come to rest.
constexpr int kRestTicks = 400, kEnterTicks = 300, kCalmTicks = 300;

}  // namespace

DynamicWorld::DynamicWorld(const Scene& scene, const std::vector<Archive>& archives)
    : dt_(1.0 / scene.rates.haptic_hz), in_tick_(scene.tools.size()) {
  tools_.reserve(scene.tools.size());
  for (const Tool& tool : scene.tools) tools_.emplace_back(tool, dt_);
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
  return state.tool < tools_.size() && tools_[state.tool].take(state);
}

void DynamicWorld::leave(int tool) {
  tools_[tool].leave();
}

void DynamicWorld::tick() {
  if (ticks_ % keyframe_interval() == 0)
    for (auto& organ : organs_) organ->forget_factors();
  for (TissueTool& tool : tools_) tool.tick(ticks_);
  see_tools();
  for (auto& organ : organs_) organ->tick(in_tick_, dt_);
  ++ticks_;
}

void DynamicWorld::see_tools() {
  for (int t = 0; t < tools(); ++t) in_tick_[t] = tools_[t].in_tick();
}

// Where they are in truth.
void DynamicWorld::meet_tools() {
  for (TissueTool& tool : tools_) tool.enter(1);
  see_tools();
  for (auto& organ : organs_) organ->meet(in_tick_);
}

// It may have pressed tissue to where it is: that is whole.
bool DynamicWorld::presses(int tool) const {
  return std::ranges::all_of(organs_, [&](const auto& o) { return o->removed().empty() && !o->passes(tool); });
}

bool DynamicWorld::settle() {
  const int entering = settled_ - kRestTicks;
  // Fast through free space, slowly at the end, where it meets the tissue.
  const double left = std::clamp(1 - static_cast<double>(entering) / kEnterTicks, 0.0, 1.0);
  if (entering == 0) meet_tools();
  if (entering >= 0)
    for (int t = 0; t < tools(); ++t) tools_[t].enter(presses(t) ? 1 - left * left : 1);
  see_tools();
  for (auto& organ : organs_) organ->settle(in_tick_, dt_);
  return ++settled_ >= kRestTicks + kEnterTicks + kCalmTicks;
}

void DynamicWorld::state(State& s) {
  s.value(ticks_);
  std::vector<MovingTool> moving;
  for (TissueTool& tool : tools_) {
    tool.state(s);
    moving.push_back(tool.in_tick().moving);
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
  Hash64 hash;
  State s = State::hash(hash);
  for (const auto& organ : organs_) organ->state(s, {});
  return hash.value();
}

}  // namespace palpate
