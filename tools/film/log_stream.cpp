#include "tools/film/log_stream.hpp"

namespace palpate {
namespace {

std::set<std::string> without_statuses(std::set<std::string> topics) {
  topics.erase(topics::node_status.name);
  return topics;
}

NodeStatus status_of(const std::string& role, const LoadedScene& scene) {
  NodeStatus status;
  status.node = "log " + role;
  status.role = role;
  status.scene_hash = scene.scene_hash;
  status.archive_hash = scene.archive_hash;
  status.version = PALPATE_VERSION;
  return status;
}

}  // namespace

LogStream::LogStream(const std::filesystem::path& log, const LogContents& contents, const LoadedScene& scene, Bus& bus)
    : reader_(log), sender_(bus, without_statuses(contents.topics)), statuses_(bus.writer(topics::node_status)) {
  haptic_ = status_of("haptic", scene);
  deform_ = status_of("deform", scene);
}

// A tool's state is the first that a haptic node tells of a step; of the other node's run, what is cut is the first
// that somebody asks for.
void LogStream::look(const LogEvent& event) {
  NodeStatus status;
  if (event.read(topics::node_status, status) && status.role == "haptic") haptic_hz_ = status.rate_hz;
  ToolState tool;
  if (event.read(topics::tool_state, tool)) announce(haptic_, tool.run, event.receive_ns);
  TopologyChange change;
  if (event.read(topics::topology_change, change)) announce(deform_, change.run, event.receive_ns);
}

void LogStream::announce(NodeStatus& node, std::uint64_t run, std::int64_t at) {
  if (run == node.run) return;
  node.run = run;
  ++node.seq;
  node.stamp_ns = at;
  statuses_->write(node);
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
