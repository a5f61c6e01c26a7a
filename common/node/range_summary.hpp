#pragma once
#include <nlohmann/json_fwd.hpp>

#include "common/sim/range_monitor.hpp"

namespace palpate {

/// For a node's summary: how far each watched body went, and whether that was beyond its range.
nlohmann::json range_summary(const RangeMonitor& monitor);

}  // namespace palpate
