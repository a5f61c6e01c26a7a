#pragma once
#include <set>
#include <string>

#include "common/bus/bus.hpp"

namespace palpate {

/// Before `topics` of a log are played to a bus that has no writers of them yet: looks for a second, in which nodes
/// find one another, who is there. Throws std::runtime_error, which names who and what to do, where the replay would
/// speak for a haptic or deform node that lives, or move the motors of a driver.
void look_who_is_there(Bus& bus, const std::set<std::string>& topics);

}  // namespace palpate
