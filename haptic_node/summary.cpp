#include "haptic_node/summary.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/bus/task_figures.hpp"
#include "common/log/log.hpp"
#include "common/node/handling_summary.hpp"
#include "common/sim/step_messages.hpp"

namespace palpate {
namespace {

double rate(const LoopReport& r) {
  return r.seconds > 0 ? static_cast<double>(r.ticks) / r.seconds : 0.0;
}

}  // namespace

nlohmann::json summary_of(const LoopReport& r) {
  const auto us = [](const Histogram& h, double share) { return 1e-3 * static_cast<double>(h.percentile(share)); };
  return {{"node", "haptic"},
          {"seconds", r.seconds},
          {"rate_hz", rate(r)},
          {"ticks", r.ticks},
          {"missed", r.period.skipped},
          {"dropped", r.dropped},
          {"step_us_p50", us(r.step, 0.5)},
          {"step_us_p99", us(r.step, 0.99)},
          {"step_us_p999", us(r.step, 0.999)},
          {"step_us_max", us(r.step, 1)},
          {"push_us_p50", us(r.push, 0.5)},
          {"ring_to_wire_us_p50", us(r.wire, 0.5)},
          {"ring_to_wire_us_p99", us(r.wire, 0.99)},
          {"late_us_p50", us(r.period.wake, 0.5)},
          {"late_us_p99", us(r.period.wake, 0.99)},
          {"slack_us_p50", us(r.period.slack, 0.5)},
          {"slack_us_p1", us(r.period.slack, 0.01)},
          {"force_max_n", r.max_force},
          {"limited_steps", r.limited},
          {"force_limited_steps", r.force_limited},
          {"slew_limited_steps", r.slew_limited},
          {"silent_device_steps", r.silent},
          {"behind_s", r.behind},
          {"regularised_steps", r.regularised},
          {"fault_steps", r.faults},
          {"stale_model_steps", r.stale},
          {"late_tissue_steps", r.late},
          {"refused_samples", r.refused_samples},
          {"followed_steps", r.followed_samples},
          {"refused_models", r.refused_models},
          {"implausible_models", r.implausible_models},
          {"implausible_force_steps", r.implausible},
          {"refused_messages", r.refused_messages},
          {"passivity_limited_steps", r.damped},
          {"energy_min_j", r.min_energy}};
}

void say(const LoopReport& r) {
  if (r.damped > 0)
    log_info(
        fmt::format("{} steps were damped, as the tools took out more energy than they had put in: {:.1f} mJ at most",
                    r.damped, -1e3 * r.min_energy));
  const auto us = [&](double share) { return 1e-3 * static_cast<double>(r.step.percentile(share)); };
  log_info(fmt::format(
      "{:.1f} Hz over {:.1f} s, step p50 {:.1f} us, p99.9 {:.1f} us, missed {} ticks, largest force {:.2f} N", rate(r),
      r.seconds, us(0.5), us(0.999), r.period.skipped, r.max_force));
}

nlohmann::json tasks_of(const HapticStep& haptic, const Scene& scene) {
  nlohmann::json tasks = nlohmann::json::array();
  for (const TaskRecord& task : task_records(haptic)) {
    const std::string& body = name_of(scene.bodies[task.body]);
    tasks.push_back(task_summary(body, task));
    log_info(fmt::format("task of '{}': {}", body, fmt::join(task_lines(task), ", ")));
  }
  return tasks;
}

}  // namespace palpate
