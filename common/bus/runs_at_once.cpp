#include "common/bus/runs_at_once.hpp"

#include <fmt/format.h>

#include <utility>

#include "idl/topics.hpp"

namespace palpate {

// By one tool: others of a step may come before it or behind.
void RunsAtOnce::add(const LogEvent& event) {
  if (log_begin_ns_ == 0) log_begin_ns_ = event.receive_ns;
  ToolState state;
  if (!event.read(topics::tool_state, state) || state.tool != 0) return;
  const bool is_new = begin_ns_.try_emplace(state.run, event.receive_ns).second;
  const std::uint64_t before = std::exchange(current_, state.run);
  if (is_new || before == state.run) return;
  if (both_.begin_ns == 0) both_ = {state.run, before, begin_ns_[before], 0};
  both_.end_ns = event.receive_ns;
}

std::string RunsAtOnce::text() const {
  if (both_.begin_ns == 0) return {};
  const auto seconds = [&](std::int64_t time) { return 1e-9 * static_cast<double>(time - log_begin_ns_); };
  return fmt::format("it holds two runs at once, {:016x} and {:016x}, from {:.1f} s to {:.1f} s", both_.first,
                     both_.second, seconds(both_.begin_ns), seconds(both_.end_ns));
}

std::string runs_at_once(const std::filesystem::path& log) {
  LogReader reader(log);
  RunsAtOnce runs;
  for (LogEvent event; reader.next(event);) runs.add(event);
  return runs.text();
}

}  // namespace palpate
