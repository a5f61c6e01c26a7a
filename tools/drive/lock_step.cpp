#include "tools/drive/lock_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace palpate::drive {

std::vector<std::unique_ptr<Device>> lock_step_devices(const Scene& scene) {
  std::vector<std::unique_ptr<Device>> devices = make_devices(scene.tools, scene.rates.haptic_hz);
  for (std::size_t t = 0; t < devices.size(); ++t)
    if (devices[t]->on_bus())
      throw std::runtime_error(fmt::format(
          "tool '{}' is moved by a driver elsewhere (device '{}'), which lock step does not wait for: give it a motion "
          "with --set tool.{}.device=scripted and --set tool.{}.trajectory=FILE",
          scene.tools[t].name, kind_of(scene.tools[t].device), scene.tools[t].name, scene.tools[t].name));
  return devices;
}

LockStep::LockStep(const Scene& scene, const std::vector<Archive>& archives)
    : simulator_(scene, archives), devices_(lock_step_devices(scene)), inputs_(scene.tools.size()) {
  for (int t = 0; t < simulator_.tools(); ++t) {
    guards_.emplace_back(scene.tools[t].motion, simulator_.dt());
    inputs_[t] = devices_[t]->read(0);
  }
  simulator_.start(inputs_);
}

bool LockStep::motions_over() const {
  return !devices_.empty() &&
         std::ranges::all_of(devices_, [&](const auto& device) { return device->finished(time()); });
}

void LockStep::step() {
  std::vector<sim::ToolInput> inputs;
  for (const auto& device : devices_) inputs.push_back(device->read(time()));
  step(inputs);
  for (int t = 0; t < simulator_.tools(); ++t) {
    const sim::ToolView tool = simulator_.tool(t);
    devices_[t]->render({tool.force, tool.torque}, tool.grip_torque);
  }
}

void LockStep::step(std::span<const sim::ToolInput> inputs) {
  for (std::size_t t = 0; t < inputs_.size(); ++t)
    inputs_[t] = {guards_[t].follow(inputs[t].dofs, inputs[t].seq), inputs[t].seq};
  simulator_.step(inputs_);
}

}  // namespace palpate::drive
