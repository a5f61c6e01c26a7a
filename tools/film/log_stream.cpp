#include "tools/film/log_stream.hpp"

namespace palpate {
namespace {

std::set<std::string> without_statuses(std::set<std::string> topics) {
  topics.erase(topics::node_status.name);
  return topics;
}

}  // namespace

LogStream::LogStream(const std::filesystem::path& log, const LogContents& contents, const LoadedScene& scene, Bus& bus)
    : reader_(log), sender_(bus, without_statuses(contents.topics)), statuses_(bus.writer(topics::node_status)) {
  haptic_.node = "log";
  haptic_.role = "haptic";
  haptic_.scene_hash = scene.scene_hash;
  haptic_.archive_hash = scene.archive_hash;
  haptic_.version = PALPATE_VERSION;
}

// A tool's state is the first that a haptic node tells of a step.
void LogStream::look(const LogEvent& event) {
  NodeStatus status;
  if (event.read(topics::node_status, status) && status.role == "haptic") haptic_hz_ = status.rate_hz;
  ToolState tool;
  if (!event.read(topics::tool_state, tool) || tool.run == haptic_.run) return;
  haptic_.run = tool.run;
  ++haptic_.seq;
  haptic_.stamp_ns = event.receive_ns;
  statuses_->write(haptic_);
}

bool LogStream::send_until(double seconds) {
  while (waits_ || reader_.next(next_)) {
    if (!waits_) next_s_ = 1e-9 * static_cast<double>(time_.since_start(next_.receive_ns));
    waits_ = next_s_ > seconds;
    if (waits_) return true;
    look(next_);
    sender_.send(next_, next_.receive_ns);
  }
  return false;
}

}  // namespace palpate
