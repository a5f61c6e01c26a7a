#pragma once
#include <cstdint>

#include "common/tool/kinematics.hpp"

namespace palpate {

/// One tool's input of a step.
struct DeviceSample {
  ToolDofs dofs;
  std::uint64_t seq = 0;  ///< of the device's sample; 0 for a scripted tool
};

}  // namespace palpate
