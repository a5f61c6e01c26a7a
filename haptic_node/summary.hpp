#pragma once
#include <nlohmann/json_fwd.hpp>

#include "haptic_node/haptic_loop.hpp"

namespace palpate {

/// What a run of the loop measured.
nlohmann::json summary_of(const LoopReport& report);
/// The same for who reads along.
void say(const LoopReport& report);
/// How the tasks of a scene ended, one entry a body that has one; it is said to who reads along, too.
nlohmann::json tasks_of(const HapticStep& haptic, const Scene& scene);

}  // namespace palpate
