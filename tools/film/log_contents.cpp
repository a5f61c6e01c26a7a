#include "tools/film/log_contents.hpp"

#include <algorithm>

#include "common/bus/log_reader.hpp"
#include "idl/topics.hpp"
#include "tools/logs/log_time.hpp"

namespace palpate {

LogContents contents_of(const std::filesystem::path& log, const Scene& scene) {
  LogContents all;
  LogReader reader(log);
  LogTime time;
  SurfaceState surface;
  ToolState tool;
  for (LogEvent event; reader.next(event);) {
    const bool first_of_topic = all.topics.insert(event.channel).second;
    const double now = 1e-9 * static_cast<double>(time.since_start(event.receive_ns));
    all.seconds = std::max(all.seconds, now);
    if (first_of_topic && event.read(topics::tool_state, tool))
      all.scene_begin = now - static_cast<double>(tool.step) / scene.rates.haptic_hz;
    if (event.read(topics::surface_state, surface)) all.shaped.insert(surface.body);
  }
  return all;
}

}  // namespace palpate
