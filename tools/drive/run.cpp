#include "tools/drive/run.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "common/fem/stopwatch.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/shutdown.hpp"
#include "common/scene/ensure_archive.hpp"
#include "tools/drive/course.hpp"
#include "tools/drive/lock_step.hpp"
#include "tools/drive/step_log.hpp"

namespace palpate::drive {
namespace {

constexpr std::int64_t kProgressNs = kNsPerS / 4;

/// One run with what looks on.
class Run {
 public:
  Run(const Scene& scene, const RunSettings& settings, const std::vector<Archive>& archives)
      : settings_(settings), lock_step_(scene, archives), watch_(lock_step_.simulator(), archives) {
    disappointments(settings.expected, figures(0));  // before anything is computed: is there what is expected
    if (!settings.log.empty()) log_.emplace(settings.log, lock_step_.simulator());
    if (!settings.course.empty()) course_.emplace(settings.course, scene);
  }

  PointResult to_its_end() {
    const std::int64_t begin = now_ns();
    std::int64_t next_progress = begin + kProgressNs;
    while (!over()) {
      step();
      const std::int64_t now = now_ns();
      if (now < next_progress) continue;
      next_progress = now + kProgressNs;
      if (settings_.progress) settings_.progress(lock_step_.time(), 1e-9 * static_cast<double>(now - begin));
      stop_if_interrupted();
    }
    if (log_) log_->finish();
    if (course_) course_->finish();
    PointResult result{.figures = figures(1e-9 * static_cast<double>(now_ns() - begin))};
    result.reason = disappointments(settings_.expected, result.figures);
    if (!result.reason.empty()) result.outcome = PointResult::kUnexpected;
    return result;
  }

 private:
  bool over() const {
    return lock_step_.motions_over() || (settings_.seconds > 0 && lock_step_.time() >= settings_.seconds);
  }

  void step() {
    if (log_) log_->before_step();
    lock_step_.step();
    watch_.look(lock_step_.simulator());
    if (log_) log_->after_step();
    if (course_) course_->write(lock_step_.simulator());
  }

  Figures figures(double wall_seconds) const {
    Figures all = watch_.figures(lock_step_.simulator());
    for (int t = 0; t < lock_step_.simulator().tools(); ++t) {
      const std::string name = fmt::format("tool.{}.", lock_step_.simulator().scene().tools[t].name);
      all.push_back({name + "refused", static_cast<double>(lock_step_.guard(t).refused()), "1"});
      all.push_back({name + "followed", static_cast<double>(lock_step_.guard(t).followed()), "1"});
    }
    all.push_back({"wall", wall_seconds, "s"});
    all.push_back({"realtime_factor", wall_seconds > 0 ? lock_step_.time() / wall_seconds : 0, "1"});
    return all;
  }

  const RunSettings& settings_;
  LockStep lock_step_;
  Watch watch_;
  std::optional<StepLog> log_;
  std::optional<Course> course_;
};

}  // namespace

PointResult run_scene(const Scene& scene, const RunSettings& settings) {
  if (scene.tools.empty() && settings.seconds == 0)
    throw std::runtime_error("the scene has no tool whose motion ends the run: say how long it is by --seconds");
  const std::vector<Archive> archives = load_or_precompute(scene, ArchivePart::surface);
  return Run(scene, settings, archives).to_its_end();
}

}  // namespace palpate::drive
