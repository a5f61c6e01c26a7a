#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "common/describe/description.hpp"
#include "common/tool/trajectory.hpp"

namespace palpate {

/// Whether a person may take the tool away from what moves it, by a driver elsewhere such as the live view.
enum class ForHands { never, if_asked, always };

/// The key of devices whose driver is elsewhere [s].
inline void describe_lease(Description& d, double& lease) {
  d.number({"lease", "s", "after which a driver that is silent has let go: the tool stands and its force fades",
            Need::optional, Use::local},
           lease, within(0.01, 10));
}

/// absence() of devices whose driver is elsewhere.
inline constexpr std::string_view kNoDriverElsewhere = "no tool on the bus: no device topic and no thread for it";

class Device;
struct DevicePlace;

/// What programs ask of every kind of device are functions of its spec, declared beside it. Programs call them by
/// std::visit on a DeviceSpec, and know of no kind otherwise.
///
/// make_device(spec, place): the device of a tool, defined in common/devices/. Throws std::runtime_error for a missing
/// or malformed file.
///
/// motion_file(spec): the file that its motion comes from; empty without one.
///
/// script(spec): the motion, or the one that it wants to make, that a file holds, which programs name then. Throws as
/// load_trajectory() does.
///
/// for_hands(spec): whether a person may take the tool.
///
/// absence(spec): what programs leave out where no tool of a scene has such a device; kinds with the same sentence are
/// left out together; empty: nothing.

}  // namespace palpate
