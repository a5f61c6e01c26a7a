#pragma once
#include <nlohmann/json.hpp>

#include "tools/latency/hop_times.hpp"

namespace palpate {

/// A histogram's percentiles [us]; null without samples.
inline nlohmann::ordered_json json_of(const Histogram& h) {
  if (h.count() == 0) return nullptr;
  const Percentiles p = percentiles_us(h);
  return {{"p50", p.p50}, {"p90", p.p90}, {"p99", p.p99}, {"p999", p.p999}, {"max", p.max}};
}

/// [s]; null where no tissue moves.
inline nlohmann::ordered_json json_of(const TissueCourse& tissue) {
  if (!tissue.known()) return nullptr;
  return {{"time", tissue.time_s()},
          {"late", tissue.late_s()},
          {"lost", tissue.lost_s()},
          {"lost_at_once", tissue.at_once_s()}};
}

inline nlohmann::ordered_json json_of(const HopTimes& hops) {
  return {{"tool_to_force", json_of(hops.force())},
          {"tool_to_surface", json_of(hops.surface())},
          {"tool_to_picture", json_of(hops.picture())},
          {"ahead", hops.ahead()},
          {"clock_uncertainty", 1e-3 * static_cast<double>(hops.uncertainty_ns())}};
}

}  // namespace palpate
