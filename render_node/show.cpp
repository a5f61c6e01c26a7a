#include "render_node/show.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/bus/task_figures.hpp"

namespace palpate {
namespace {

double magnitude(const ForceState& f) {
  return std::hypot(f.force[0], f.force[1], f.force[2]);
}

std::string describe(const std::string& tool, const ForceState& f) {
  std::string words = fmt::format("{}  {:.2f} N", tool, magnitude(f));
  if (f.grip != 0) words += fmt::format("  grip {:.0f} N mm", 1e3 * f.grip);
  if (f.flags & fault) return words + "  fault: force off";
  if (f.flags & (force_limited | slew_limited)) words += "  limited";
  return words;
}

}  // namespace

Show::Show(const Scene& scene, Stage stage, SurfaceSource& source, Bus& bus, const Presence& presence)
    : scene_(scene),
      stage_(std::move(stage)),
      source_(source),
      presence_(presence),
      tools_(bus.reader(topics::tool_state)),
      forces_(bus.reader(topics::force_state)),
      latest_force_(scene.tools.size()) {
  if (std::ranges::any_of(scene.bodies, [](const Body& body) { return has_task(body); }))
    tasks_ = bus.reader(topics::task_record);
}

template <class M, class Take>
void Show::take_all(Reader<M>& reader, const Take& take) {
  while (const auto message = reader.take()) refused_ += !(presence_.accepts(message->run) && take(*message));
}

bool Show::take() {
  const bool news = source_.update();
  if (topology_) follow_cuts();
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    const SurfaceSource::Shape shape = source_.shape(static_cast<int>(b));
    stage_.set_surface(static_cast<int>(b), shape.position, shape.normal, shape.dents);
  }
  take_all(*tools_, [&](const ToolState& tool) { return stage_.set_tool(tool); });
  take_all(*forces_, [&](const ForceState& force) {
    if (force.tool >= latest_force_.size()) return false;
    latest_force_[force.tool] = force;
    return true;
  });
  if (!tasks_) return news;
  take_all(*tasks_, [&](const TaskRecord& task) {
    if (task.body >= scene_.bodies.size() || !has_task(scene_.bodies[task.body])) return false;
    latest_task_[task.body] = task;
    return true;
  });
  return news;
}

void Show::follow_cuts() {
  for (const int body : topology_->take()) {
    if (stage_.has_visual(body)) stage_.part_visual(body, topology_->pieces(body));
    stage_.set_triangles(body, topology_->triangles(body));
  }
}

void Show::tell(const std::vector<std::string>& above) {
  std::vector<std::string> lines{scene_.title.empty() ? scene_.file.stem().string() : scene_.title};
  lines.insert(lines.end(), above.begin(), above.end());
  for (const auto& [body, task] : latest_task_)
    for (const std::string& line : task_lines(task)) lines.push_back(line);
  double strongest = 0, full = 1;
  for (std::size_t i = 0; i < latest_force_.size(); ++i) {
    lines.push_back(describe(scene_.tools[i].name, latest_force_[i]));
    strongest = std::max(strongest, magnitude(latest_force_[i]));
    full = i == 0 ? scene_.tools[i].max_force : std::max(full, scene_.tools[i].max_force);
  }
  std::optional<Gauge> gauge;
  if (!latest_force_.empty()) gauge = Gauge{strongest, full, "N"};
  stage_.set_overlay(std::move(lines), gauge);
  peak_force_ = std::max(peak_force_, strongest);
  if (strongest > 1.01 * best_force_) {
    best_force_ = strongest;
    best_ = stage_;
  }
}

}  // namespace palpate
