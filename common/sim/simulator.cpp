#include "common/sim/simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace palpate::sim {
namespace {

const Scene& checked(const Scene& scene) {
  if (scene.tools.size() > StepRecord::kMaxTools)
    throw std::runtime_error(
        fmt::format("{} tools; at most {} run in one scene", scene.tools.size(), StepRecord::kMaxTools));
  return scene;
}

// What the deformer rebuilds the bodies of the haptic step from.
void show(const StepRecord& record, std::vector<ContactState>& contacts, Deformer& deformer) {
  for (std::size_t t = 0; t < contacts.size(); ++t) {
    describe_contacts(record, static_cast<int>(t), contacts[t]);
    deformer.take(contacts[t]);
  }
  for (const BodyNews& news : record.news)
    if (news.due(record.step)) deformer.take(news.message);
}

void stamp(StepRecord& record) {
  for (BodyNews& news : record.news) std::visit([](auto& m) { m.run = Simulator::kRun; }, news.message);
}

}  // namespace

Simulator::Simulator(const Scene& scene, const std::vector<Archive>& archives)
    : scene_(checked(scene)),
      haptic_(scene_, archives),
      world_(scene_, archives),
      local_models_(world_, archives, LocalStiffness::Worker::caller),
      deformer_(scene_, archives),
      dofs_(scene_.tools.size()),
      contacts_(scene_.tools.size(), ContactState{.run = kRun}),
      models_(scene_.tools.size()) {
  prepare_record(haptic_, record_);
  stamp(record_);
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
  show(record_, contacts_, deformer_);
  if (world_.organs() > 0) move_tissue();
  ++steps_;
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
    LocalContactModel& model = models_[t];
    local_models_.describe(t, model);
    model.run = kRun;
    model.seq = steps_ + 1;
    haptic_.consume(model);
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

int Simulator::organ_of(int body) const {
  const auto found = std::ranges::find(world_.bodies(), body);
  return found == world_.bodies().end() ? -1 : static_cast<int>(found - world_.bodies().begin());
}

SurfaceView Simulator::surface(int body) {
  if (const int moving = organ_of(body); moving >= 0) {
    world_.organ(moving).shape(position_, normal_);
    return {world_.organ(moving).origin(), position_, normal_};
  }
  if (deformer_.fresh()) deformer_.deform();
  return {deformer_.shape(body).origin(), deformer_.surface(body).position, deformer_.surface(body).normal};
}

// As the haptic step is, also between the steps at which walls and catheters are shown.
void Simulator::show_now() {
  StepRecord record{};
  prepare_record(haptic_, record);
  stamp(record);
  fill_record(haptic_, std::vector<ToolInput>(dofs_.size()), 0, 0, record);
  std::vector<ContactState> contacts(dofs_.size(), ContactState{.run = kRun});
  show(record, contacts, deformer_);
  deformer_.deform();
}

std::vector<Eigen::Vector3d> Simulator::displacement(int body) {
  std::vector<Eigen::Vector3d> u;
  if (const int moving = organ_of(body); moving >= 0) {
    const DynamicOrgan& organ = world_.organ(moving);
    for (int n = 0; n < deformer_.map(body).size(); ++n) u.push_back(organ.displacement(n));
    return u;
  }
  show_now();
  for (const Eigen::Vector3f& d : deformer_.surface(body).displacement) u.push_back(d.cast<double>());
  return u;
}

}  // namespace palpate::sim
