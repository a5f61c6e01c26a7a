#include "common/node/handling_summary.hpp"

#include <nlohmann/json.hpp>

#include "common/bus/task_figures.hpp"

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

nlohmann::json task_summary(const std::string& body, const TaskRecord& task) {
  nlohmann::json summary{{"body", body}};
  for (const TaskFigure& figure : task_figures())
    std::visit([&](const auto member) { summary[figure.key()] = task.*member; }, figure.field);
  return summary;
}

nlohmann::json resection_summary(const std::string& body, const Resection& resection) {
  return {{"body", body},
          {"cut_inside", resection.inside().tetrahedra},
          {"cut_inside_m3", resection.inside().volume},
          {"cut_outside", resection.outside().tetrahedra},
          {"cut_outside_m3", resection.outside().volume}};
}

}  // namespace palpate
