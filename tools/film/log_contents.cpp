#include "tools/film/log_contents.hpp"

#include <algorithm>

#include "common/bus/log_reader.hpp"
#include "idl/topics.hpp"
#include "tools/logs/log_time.hpp"

namespace palpate {

LogContents contents_of(const std::filesystem::path& log) {
  LogContents all;
  LogReader reader(log);
  LogTime time;
  SurfaceState surface;
  for (LogEvent event; reader.next(event);) {
    all.topics.insert(event.channel);
    all.seconds = std::max(all.seconds, 1e-9 * static_cast<double>(time.since_start(event.receive_ns)));
    if (event.read(topics::surface_state, surface)) all.shaped.insert(surface.body);
  }
  return all;
}

}  // namespace palpate
