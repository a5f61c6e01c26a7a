#include "common/node/handling_summary.hpp"

#include <nlohmann/json.hpp>

namespace palpate {

nlohmann::json handling_summary(const std::string& tool, const HandlingFigures& f) {
  return {{"name", tool},
          {"seconds", f.seconds},
          {"path_m", f.path},
          {"economy", f.economy},
          {"jerk_m_s3", f.jerk},
          {"touches", f.touches},
          {"touching_s", f.touching},
          {"force_max_n", f.max_force},
          {"force_mean_n", f.mean_force},
          {"impulse_n_s", f.impulse},
          {"force_change_max_n", f.max_change}};
}

}  // namespace palpate
