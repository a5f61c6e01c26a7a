#include "tools/film/log_contents.hpp"

#include <algorithm>

#include "common/bus/log_reader.hpp"
#include "idl/topics.hpp"

namespace palpate {

LogContents contents_of(const std::filesystem::path& log) {
  LogContents all;
  LogReader reader(log);
  SurfaceState surface;
  for (LogEvent event; reader.next(event);) {
    if (all.topics.empty()) all.first_ns = event.receive_ns;
    all.topics.insert(event.channel);
    all.last_ns = std::max(all.last_ns, event.receive_ns);
    if (event.read(topics::surface_state, surface)) all.shaped.insert(surface.body);
  }
  return all;
}

}  // namespace palpate
