#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/presence.hpp"
#include "common/devices/device.hpp"
#include "common/sim/haptic_step.hpp"

namespace palpate {

/// Puts the tools where their devices have them. Where one is within a body, the last contacts of a haptic node that
/// died are taken up, if peers with the same scene keep them. Returns how many of their messages were refused. Throws
/// std::runtime_error if a tool starts within a body without contacts.
std::uint64_t start_tools(HapticStep& haptic, std::vector<std::unique_ptr<Device>>& devices, Bus& bus,
                          Presence& presence);

}  // namespace palpate
