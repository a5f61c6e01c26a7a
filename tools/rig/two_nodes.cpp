#include "tools/rig/two_nodes.hpp"

namespace palpate {

TwoNodes::TwoNodes(const Scene& scene, const std::vector<Archive>& archives) : scene_(scene), archives_(archives) {
  make_tissue();
  phase_ = Phase::moving;
}

void TwoNodes::start(std::span<const ToolDofs> dofs) {
  make_haptic(dofs);
}

void TwoNodes::restart_tissue() {
  make_tissue();
  phase_ = Phase::settling;
}

void TwoNodes::restart_haptic(std::span<const ToolDofs> dofs) {
  make_haptic(dofs);
}

void TwoNodes::make_haptic(std::span<const ToolDofs> dofs) {
  haptic_ = std::make_unique<HapticStep>(scene_, archives_);
  haptic_->start(dofs);
  ++haptic_run_;
}

void TwoNodes::make_tissue() {
  std::vector<std::vector<std::uint32_t>> removed;
  if (world_)
    for (int i = 0; i < world_->organs(); ++i)
      removed.emplace_back(world_->organ(i).removed().begin(), world_->organ(i).removed().end());
  models_.reset();
  world_ = std::make_unique<DynamicWorld>(scene_, archives_);
  models_ = std::make_unique<LocalModels>(*world_, archives_, LocalStiffness::Worker::caller);
  for (std::size_t i = 0; i < removed.size(); ++i) world_->organ(static_cast<int>(i)).begin_without(removed[i]);
  model_.assign(scene_.tools.size(), {});
  ++tissue_run_;
}

void TwoNodes::step(std::span<const ToolDofs> dofs) {
  if (haptic_) haptic_->step(dofs);
  if (phase_ == Phase::gone) return;
  if (haptic_) tell_tissue(dofs);
  if (phase_ == Phase::settling) settle();
  if (phase_ == Phase::moving) tick();
}

void TwoNodes::tell_tissue(std::span<const ToolDofs> dofs) {
  for (int t = 0; t < haptic_->tools(); ++t)
    world_->take({.tool = static_cast<std::uint32_t>(t),
                  .run = haptic_run_,
                  .seq = haptic_->steps(),
                  .step = haptic_->steps() - 1,
                  .yaw = dofs[t].yaw,
                  .pitch = dofs[t].pitch,
                  .depth = dofs[t].depth,
                  .roll = dofs[t].roll,
                  .grip = dofs[t].grip,
                  .opening = haptic_->opening(t),
                  .holding = haptic_->rig(t).end().holding(),
                  .pedal = dofs[t].pedal});
}

void TwoNodes::settle() {
  for (int i = 0; i < kSettlingTicks && phase_ == Phase::settling; ++i)
    if (world_->settle()) phase_ = Phase::moving;
}

void TwoNodes::tick() {
  world_->tick();
  models_->refresh();
  std::vector<LocalContactModel>& told = under_way_.emplace_back();
  for (int t = 0; t < world_->tools(); ++t)
    if (world_->tool(t).follows()) told.push_back(describe(t));
  if (under_way_.size() <= delay_) return;
  // What is told of another haptic node's steps is none of this one's.
  for (const LocalContactModel& model : under_way_.front())
    if (haptic_ && model.tool_run == haptic_run_ && model.tool_step < haptic_->steps())
      refused_ += !haptic_->consume(model);
  under_way_.pop_front();
}

const LocalContactModel& TwoNodes::describe(int tool) {
  LocalContactModel& model = model_[tool];
  models_->describe(tool, model);
  model.run = tissue_run_;
  ++model.seq;
  return model;
}

Eigen::Vector3d TwoNodes::force(int tool) const {
  return haptic_ ? haptic_->force(tool) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

}  // namespace palpate
