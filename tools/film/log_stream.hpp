#pragma once
#include <filesystem>

#include "common/bus/bus.hpp"
#include "common/node/node_setup.hpp"
#include "tools/film/log_contents.hpp"
#include "tools/logs/log_sender.hpp"
#include "tools/logs/log_time.hpp"

namespace palpate {

/// Brings a log to a bus in the order of its times, as far as somebody wants to see it. The nodes whose samples come,
/// the haptic one and the one that owns moving tissue, are announced as ones of this scene.
class LogStream {
 public:
  LogStream(const std::filesystem::path& log, const LogContents& contents, const LoadedScene& scene, Bus& bus);

  /// Sends what had come until `seconds` after the log's first sample; false once there is no more.
  bool send_until(double seconds);
  std::string damage_text() const { return reader_.damage_text(); }  ///< of what has been read
  double haptic_hz() const { return haptic_hz_; }                    ///< as the node said last, 0: it has not

 private:
  void look(const LogEvent& event);
  /// Tells of a node's run where it is another than the last that was told.
  void announce(NodeStatus& node, std::uint64_t run, std::int64_t at);

  LogReader reader_;
  LogTime time_;
  LogSender sender_;
  std::unique_ptr<Writer<NodeStatus>> statuses_;
  NodeStatus haptic_, deform_;
  double haptic_hz_ = 0;
  LogEvent next_;
  double next_s_ = 0;   ///< [s] its time
  bool waits_ = false;  ///< it is yet to be sent
};

}  // namespace palpate
