#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace palpate {

/// What the guards before the hand had to do in a run that a sound one does not need, in a sentence; empty: nothing.
/// `summary`: of all nodes, by their names.
std::string interventions_in(const nlohmann::json& summary);

/// Steps that the haptic node could not tell, in a sentence; empty: there are none.
std::string untold_steps_in(const nlohmann::json& summary);

/// What belongs to a sound run too: limits of rise, damping, and what a machine with too much to do left out, as parts
/// of a line; empty: nothing.
std::string limits_met_in(const nlohmann::json& summary);

}  // namespace palpate
