#include "tools/run_summary.hpp"

#include <fmt/format.h>

#include "common/bus/task_figures.hpp"
#include "tools/guard_summary.hpp"

namespace palpate {

void print_summary(const nlohmann::json& s) {
  const auto number = [](const nlohmann::json& j, const char* key) {
    return j.is_object() && j.contains(key) ? j[key].get<double>() : 0.0;
  };
  // What a node says at its end; nothing of one that was stopped before it had begun.
  const auto said_by = [&](const char* node) { return s.value(node, nlohmann::json()); };
  const nlohmann::json haptic = said_by("haptic_node"), render = said_by("render_node"),
                       deform = said_by("deform_node"), recorder = said_by("recorder");
  if (haptic.is_object())
    fmt::print(
        "haptic   {:8.1f} Hz   step p50 {:.1f} us, p99 {:.1f} us, p99.9 {:.1f} us   missed {} of {} ticks   largest "
        "force {:.2f} N\n",
        number(haptic, "rate_hz"), number(haptic, "step_us_p50"), number(haptic, "step_us_p99"),
        number(haptic, "step_us_p999"), haptic.value("missed", 0), haptic.value("ticks", 0),
        number(haptic, "force_max_n"));
  if (haptic.is_object() && haptic.contains("tasks"))
    for (const auto& task : haptic["tasks"]) {
      const auto value = [&](const TaskFigure& figure) { return number(task, figure.key().c_str()); };
      fmt::print("task     '{}': {}\n", task.value("body", ""), fmt::join(task_lines(value), ", "));
    }
  if (render.is_object())
    fmt::print("render   {:8.1f} Hz   tool to picture p50 {:.2f} ms, p99 {:.2f} ms   {} frames\n",
               number(render, "rate_hz"), 1e-3 * number(render, "latency_us_p50"),
               1e-3 * number(render, "latency_us_p99"), render.value("frames", 0));
  if (render.is_object() && render.contains("film_frames"))
    fmt::print("film     {} frames   {} repeat the picture before, {} pictures skipped   longest stand {:.2f} s\n",
               render.value("film_frames", 0), render.value("film_repeated", 0), render.value("film_skipped", 0),
               number(render, "film_longest_stand_s"));
  if (deform.is_object() && deform.contains("tick_hz"))
    fmt::print(
        "tissue   {:8.1f} Hz   tick p50 {:.1f} us, p99 {:.1f} us   missed {} of {} ticks   {} tetrahedra cut, {} torn, "
        "{} fallen away\n",
        number(deform, "tick_hz"), number(deform, "tick_us_p50"), number(deform, "tick_us_p99"),
        deform.value("missed", 0), deform.value("ticks", 0), deform.value("tetrahedra_cut", 0),
        deform.value("tetrahedra_torn", 0), deform.value("tetrahedra_fallen", 0));
  if (deform.is_object())
    fmt::print("deform   {:8.1f} Hz   tool to surface p50 {:.1f} us, p99 {:.1f} us\n", number(deform, "rate_hz"),
               number(deform, "latency_us_p50"), number(deform, "latency_us_p99"));
  if (const nlohmann::json web = said_by("web_node"); web.is_object())
    fmt::print(
        "web      {:8.1f} Hz   tool to frame p50 {:.2f} ms, p99 {:.2f} ms   {} requests refused, {} pages thrown out\n",
        number(web, "rate_hz"), 1e-3 * number(web, "latency_us_p50"), 1e-3 * number(web, "latency_us_p99"),
        web.value("refused_requests", 0), web.value("thrown_out", 0));
  if (recorder.is_object())
    fmt::print("recorder {} messages, {} lost, {} that did not reach it\n", recorder.value("messages", 0),
               recorder.value("lost", 0), recorder.value("missing", 0));
  if (const std::string limits = limits_met_in(s); !limits.empty()) fmt::print("limits   {}\n", limits);
}

}  // namespace palpate
