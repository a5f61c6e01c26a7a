#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/dynamics/resection.hpp"
#include "common/sim/handling.hpp"
#include "idl/messages.hpp"

namespace palpate {

/// How a tool was handled, for summaries and reports.
nlohmann::json handling_summary(const std::string& tool, const HandlingFigures& figures);
/// How a task of a body stands, for the same.
nlohmann::json task_summary(const std::string& body, const TaskRecord& task);
/// What was cut of a body where its scene marks what is to be cut off, for the same.
nlohmann::json resection_summary(const std::string& body, const Resection& resection);

}  // namespace palpate
