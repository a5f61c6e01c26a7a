#include "drivers/spacemouse/cap_motion.hpp"

#include <algorithm>

namespace palpate {
namespace {

constexpr double kSteep = 1.4;        // [rad] yaw and pitch at most, either way
constexpr double kDeep = 1;           // [m]
constexpr double kShortLever = 0.05;  // [m] nearer to the pivot the shaft does not turn faster than here
constexpr double kOpen = 0.8;         // [rad] of the jaws
constexpr double kFullTurns = 9.4;    // [rad] of roll at most, either way

}  // namespace

void CapMotion::push(const std::array<int, 6>& cap) {
  for (std::size_t i = 0; i < cap.size(); ++i) rate_[i] = std::clamp(static_cast<double>(cap[i]) / kFull, -1.0, 1.0);
}

void CapMotion::press(int button, bool down) {
  if (button == 0) dofs_.pedal = down ? 1 : 0;
  if (button == 1) shut_ = down;
}

const ToolDofs& CapMotion::step(double dt) {
  const double turn = dt * speeds_.tip / std::max(dofs_.depth, kShortLever);
  dofs_.yaw = std::clamp(dofs_.yaw + turn * rate_[0], -kSteep, kSteep);
  dofs_.pitch = std::clamp(dofs_.pitch - turn * rate_[2], -kSteep, kSteep);
  dofs_.depth = std::clamp(dofs_.depth - dt * speeds_.tip * rate_[1], 0.0, kDeep);
  dofs_.roll = std::clamp(dofs_.roll + dt * speeds_.turn * rate_[4], -kFullTurns, kFullTurns);
  dofs_.grip = std::clamp(dofs_.grip + (shut_ ? -1 : 1) * dt * speeds_.jaws, 0.0, kOpen);
  return dofs_;
}

}  // namespace palpate
