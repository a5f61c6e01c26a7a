#pragma once
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/log_writer.hpp"
#include "common/bus/thinning.hpp"

namespace palpate {

struct RecorderSettings {
  std::filesystem::path file;
  std::string version;  ///< software version, for the header
  /// Gives what goes along with a scene; not asked again for the same text. None: nothing does.
  std::function<std::vector<LogFile>(const std::string& scene)> files = nullptr;
  /// Gives what the log may go without once the scene is known. None: nothing.
  std::function<Thinning(const std::string& scene)> thinning = nullptr;
};

struct RecordedTopic {
  std::uint64_t samples = 0;  ///< received
  std::uint64_t kept = 0;     ///< of these, in the log
  std::uint64_t missing = 0;  ///< by sequence numbers: sent, but not received
  std::uint64_t invalid = 0;
};

struct RecorderReport {
  std::map<std::string, RecordedTopic> topics;  ///< by name, those with samples
  LogStatus log;
  bool has_scene = false;
  bool has_log = false;  ///< nothing takes the place of a log that was there until there is something to record
  std::uint64_t missing() const;
};

/// Writes every sample of every topic of a bus, but what it is told to leave out, into a log, and tells the others how
/// it fares (NodeStatus).
class Recorder {
 public:
  /// Throws std::runtime_error if the file cannot be created; afterwards it is a log that opens, whatever becomes of
  /// this process.
  Recorder(Bus& bus, const RecorderSettings& settings);
  ~Recorder();

  /// Waits for samples, at most `timeout`, and records what has come.
  void step(std::chrono::nanoseconds timeout);
  RecorderReport report() const;
  LogStatus log_status() const;
  /// Records what is left and closes the log.
  RecorderReport finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// "log: no space left, lost 12 messages"; empty if nothing was lost.
std::string loss_text(const LogStatus& status);

}  // namespace palpate
