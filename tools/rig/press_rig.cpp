#include "tools/rig/press_rig.hpp"

#include <algorithm>
#include <cmath>

#include "common/tool/instrument.hpp"

namespace palpate {
namespace {

// As its node would tell of it; jaws that turn stand here as the handle wants them and hold nothing.
ToolState state_of(const Tool& of, std::size_t tool, const ToolDofs& dofs, std::uint64_t tick, double dt) {
  const EndAbilities can = abilities_of(of);
  return {.tool = static_cast<std::uint32_t>(tool),
          .run = 1,
          .step = tick,
          .sense_ns = std::llround(1e9 * static_cast<double>(tick) * dt),
          .yaw = dofs.yaw,
          .pitch = dofs.pitch,
          .depth = dofs.depth,
          .roll = dofs.roll,
          .grip = dofs.grip,
          .opening = can.turning ? dofs.grip : 0,
          .holding = can.closing && dofs.grip < can.closing->closed_below,
          .pedal = dofs.pedal};
}

sim::ToolInput input_of(const ToolDofs& dofs) {
  return {.dofs = dofs};
}

}  // namespace

Eigen::Vector3d force_on_moving_part(const DynamicOrgan& organ) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const TouchContact& c : organ.contacts()) sum += c.force;
  return sum;
}

Eigen::Vector3d force_on(const DynamicOrgan& organ) {
  Eigen::Vector3d sum = force_on_moving_part(organ);
  if (const CondensedTouch* still = organ.condensed_part())
    for (std::size_t c = 0; c < still->contacts().size(); ++c) sum += still->force(static_cast<int>(c));
  return sum;
}

int held_points(const HapticStep& haptic, int body, int tool) {
  return static_cast<int>(std::ranges::count_if(haptic.part(body)->held()->contacts(), [&](const TouchContact& c) {
    return c.touch != Touch::open && (tool < 0 || c.is_by(tool));
  }));
}

PressRig::PressRig(const Scene& scene, std::vector<Archive> archives)
    : archives_(std::move(archives)), simulator_(scene, archives_), inputs_(scene.tools.size()) {}

void PressRig::start(std::span<const ToolDofs> dofs) {
  std::ranges::transform(dofs, inputs_.begin(), input_of);
  simulator_.start(inputs_);
}

void PressRig::step(std::span<const ToolDofs> dofs) {
  std::ranges::transform(dofs, inputs_.begin(), input_of);
  simulator_.step(inputs_);
}

void PressRig::press(std::span<const ToolDofs> dofs) {
  if (tissue().organs() == 0) return haptic().step(dofs);
  for (std::size_t t = 0; t < dofs.size(); ++t)
    tissue().take(state_of(scene().tools[t], t, dofs[t], tissue().ticks(), tissue().dt()));
  tissue().tick();
}

Eigen::Vector3d PressRig::force() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < simulator_.tissue().organs(); ++i) sum += force_on(simulator_.tissue().organ(i));
  if (simulator_.tissue().organs() > 0) return sum;
  for (int t = 0; t < haptic().tools(); ++t) sum -= haptic().force(t);
  return sum;
}

}  // namespace palpate
