#pragma once
#include <nlohmann/json.hpp>

namespace palpate {

/// Prints what the nodes of a run said at their ends, by their names (RunNodes::summary()), a line for each.
void print_summary(const nlohmann::json& summary);

}  // namespace palpate
