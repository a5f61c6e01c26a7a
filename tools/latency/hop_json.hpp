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

inline nlohmann::ordered_json json_of(const HopTimes& hops) {
  return {{"tool_to_force", json_of(hops.force())},
          {"tool_to_surface", json_of(hops.surface())},
          {"tool_to_picture", json_of(hops.picture())},
          {"clock_uncertainty", 1e-3 * static_cast<double>(hops.uncertainty_ns())}};
}

}  // namespace palpate
