#pragma once
#include <variant>

#include "common/tool/ends/forceps.hpp"
#include "common/tool/ends/probe.hpp"

namespace palpate {

/// The table of what may be at an instrument's end.
using ToolEndSpec = std::variant<ProbeSpec, ForcepsSpec>;

}  // namespace palpate
