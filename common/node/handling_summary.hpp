#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/sim/handling.hpp"

namespace palpate {

/// How a tool was handled, for summaries and reports.
nlohmann::json handling_summary(const std::string& tool, const HandlingFigures& figures);

}  // namespace palpate
