#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "common/describe/description.hpp"

namespace palpate {

class Device;
class Trajectory;
struct DevicePlace;

/// What programs ask of every kind of device are functions of its spec, declared beside it and defined in the kind's
/// folder. Programs call them by std::visit on a DeviceSpec, and know of no kind otherwise.
///
/// make_device(spec, place): the device of a tool of a scene. Throws std::runtime_error for a missing or malformed
/// file.
///
/// motion_file(spec): the file that its motion comes from; empty without one.
///
/// script(spec): its motion, where it is known before the run. Throws as load_trajectory() does.
///
/// absence(spec): what programs leave out where no tool of a scene has such a device; empty: nothing.

}  // namespace palpate
