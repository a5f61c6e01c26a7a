#include "common/node/range_summary.hpp"

#include <nlohmann/json.hpp>
#include <numbers>

namespace palpate {

nlohmann::json range_summary(const RangeMonitor& monitor) {
  nlohmann::json bodies = nlohmann::json::array();
  for (const RangeMonitor::Watched& body : monitor.watched())
    bodies.push_back({{"body", body.name},
                      {"left_range", body.left},
                      {"stretch_max", body.most.change.stretch},
                      {"rotation_max_deg", 180 / std::numbers::pi * body.most.change.rotation},
                      {"volume_change_max", body.most.change.volume},
                      {"fitted_force_used_max", body.most.force}});
  return bodies;
}

}  // namespace palpate
