#include "web_node/hands.hpp"

namespace palpate::web {

Hands::Hands(std::vector<OfferedTool> tools, std::uint64_t first) {
  for (OfferedTool& tool : tools) held_.push_back({.tool = std::move(tool), .base = first, .seq = first});
}

void Hands::hand_over(Held& held, std::uint32_t page) {
  held.holder = page;
  held.asker = 0;
  held.number = 0;
  held.base = held.seq;
}

void Hands::take(int tool, std::uint32_t page, double now) {
  const std::lock_guard lock(mutex_);
  if (!known(tool) || !held_[tool].tool.offered) return;
  Held& held = held_[tool];
  if (held.holder == page) return;
  const bool idle = held.holder != 0 && now - held.heard > kIdle;
  if (held.holder == 0 || idle) {
    hand_over(held, page);
    held.heard = now;
  } else {
    held.asker = page;
  }
}

void Hands::release(int tool, std::uint32_t page) {
  const std::lock_guard lock(mutex_);
  if (known(tool) && held_[tool].holder == page) hand_over(held_[tool], held_[tool].asker);
}

void Hands::give(int tool, std::uint32_t page) {
  const std::lock_guard lock(mutex_);
  if (known(tool) && held_[tool].holder == page && held_[tool].asker != 0) hand_over(held_[tool], held_[tool].asker);
}

void Hands::gone(std::uint32_t page) {
  const std::lock_guard lock(mutex_);
  for (Held& held : held_) {
    if (held.asker == page) held.asker = 0;
    if (held.holder == page) hand_over(held, held.asker);
  }
}

std::optional<DeviceState> Hands::move(int tool, std::uint32_t page, const Sample& sample, double now) {
  const std::lock_guard lock(mutex_);
  if (!known(tool)) return {};
  Held& held = held_[tool];
  if (held.holder != page || sample.number <= held.number) return {};
  held.number = sample.number;
  held.numbers[++held.seq % held.numbers.size()] = sample.number;
  if (!sample.again) held.heard = now;
  const ToolDofs dofs = dofs_for_tip(held.tool.trocar, sample.tip, sample.roll);
  return DeviceState{.tool = static_cast<std::uint32_t>(tool),
                     .seq = held.seq,
                     .yaw = dofs.yaw,
                     .pitch = dofs.pitch,
                     .depth = dofs.depth,
                     .roll = dofs.roll,
                     .grip = sample.grip,
                     .pedal = sample.pedal};
}

Hands::View Hands::view(int tool, std::uint64_t device_seq) const {
  const std::lock_guard lock(mutex_);
  const Held& held = held_.at(tool);
  const bool own = held.holder != 0 && device_seq > held.base && device_seq <= held.seq;
  const bool kept = own && held.seq - device_seq < held.numbers.size();
  return {.holder = held.holder,
          .asker = held.asker,
          .sample = kept ? held.numbers[device_seq % held.numbers.size()] : 0,
          .offered = held.tool.offered};
}

}  // namespace palpate::web
