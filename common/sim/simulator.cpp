#include "common/sim/simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace palpate::sim {
namespace {

constexpr std::uint64_t kRun = 1;  // a simulator is one start of a haptic loop and of the tissue

const Scene& checked(const Scene& scene) {
  if (scene.tools.size() > StepRecord::kMaxTools)
    throw std::runtime_error(
        fmt::format("{} tools; at most {} run in one scene", scene.tools.size(), StepRecord::kMaxTools));
  return scene;
}

}  // namespace

Simulator::Simulator(const Scene& scene, const std::vector<Archive>& archives)
    : scene_(checked(scene)),
      haptic_(scene_, archives),
      world_(scene_, archives),
      local_models_(world_, archives, LocalStiffness::Worker::caller),
      deformer_(scene_, archives),
      dofs_(scene_.tools.size()),
      contacts_(scene_.tools.size(), ContactState{.run = kRun}) {
  prepare_record(haptic_, record_);
  for (BodyNews& news : record_.news) std::visit([](auto& m) { m.run = kRun; }, news.message);
}

void Simulator::start(std::span<const ToolInput> inputs) {
  std::ranges::transform(inputs, dofs_.begin(), &ToolInput::dofs);
  haptic_.start(dofs_);
}

void Simulator::step(std::span<const ToolInput> inputs) {
  std::ranges::transform(inputs, dofs_.begin(), &ToolInput::dofs);
  if (steps_ % static_cast<std::uint64_t>(std::lround(1 / dt())) == 0) haptic_.forget_factors();
  haptic_.step(dofs_);
  const auto now_ns = static_cast<std::int64_t>(std::llround(1e9 * static_cast<double>(steps_) * dt()));
  fill_record(haptic_, inputs, steps_, now_ns, record_);
  show();
  if (world_.organs() > 0) move_tissue();
  ++steps_;
}

// What the deformer rebuilds the bodies of the haptic step from.
void Simulator::show() {
  for (int t = 0; t < tools(); ++t) {
    describe_contacts(record_, t, contacts_[t]);
    deformer_.take(contacts_[t]);
  }
  for (const BodyNews& news : record_.news)
    if (news.due(steps_)) deformer_.take(news.message);
}

// The tissue follows the tools, and the next step feels how it then is.
void Simulator::move_tissue() {
  for (int t = 0; t < tools(); ++t) {
    ToolState state = tool_state(record_, t);
    state.run = kRun;
    state.seq = steps_ + 1;
    world_.take(state);
  }
  world_.tick();
  local_models_.refresh();
  for (int t = 0; t < tools(); ++t) {
    local_models_.describe(t, model_);
    model_.run = kRun;
    model_.seq = steps_ + 1;
    haptic_.consume(model_);
  }
}

ToolView Simulator::tool(int t) const {
  return {.pose = haptic_.pose(t),
          .force = haptic_.force(t),
          .torque = haptic_.torque(t),
          .trocar_force = haptic_.trocar_force(t),
          .opening = haptic_.opening(t),
          .grip_torque = haptic_.grip_torque(t),
          .flags = haptic_.flags(t)};
}

std::vector<ChangeView> Simulator::changes() const {
  std::vector<ChangeView> all;
  for (int i = 0; i < world_.organs(); ++i)
    for (const DynamicOrgan::Change& change : world_.organ(i).changes())
      all.push_back({world_.bodies()[i], change.cause, change.removed});
  return all;
}

SurfaceView Simulator::surface(int body) {
  const auto moving = std::ranges::find(world_.bodies(), body);
  if (moving != world_.bodies().end()) {
    world_.organ(static_cast<int>(moving - world_.bodies().begin())).shape(position_, normal_);
    return {position_, normal_};
  }
  if (deformer_.fresh()) deformer_.deform();
  return {deformer_.surface(body).position, deformer_.surface(body).normal};
}

}  // namespace palpate::sim
