#include "tools/motion/rehearsal.hpp"

#include <cmath>

#include "common/sim/simulator.hpp"
#include "common/tool/devices/device_spec.hpp"

namespace palpate {

std::vector<double> Rehearsal::forces(const Trajectory& motion) const {
  std::vector<std::optional<Trajectory>> scripts;
  for (const Tool& tool : scene_.tools) scripts.push_back(script_of(tool.device));
  scripts[tool_] = motion;
  std::vector<sim::ToolInput> inputs(scripts.size());
  const auto lead = [&](double time) {
    for (std::size_t t = 0; t < scripts.size(); ++t)
      if (scripts[t]) inputs[t].dofs = scripts[t]->at(time);
  };
  sim::Simulator simulator(scene_, archives_);
  lead(0);
  simulator.start(inputs);
  std::vector<double> all(static_cast<std::size_t>(std::ceil(motion.duration() / dt())) + 1);
  for (std::size_t i = 0; i < all.size(); ++i) {
    lead(static_cast<double>(i) * dt());
    simulator.step(inputs);
    all[i] = simulator.tool(tool_).force.norm();
  }
  return all;
}

}  // namespace palpate
