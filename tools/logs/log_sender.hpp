#pragma once
#include <chrono>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/log_reader.hpp"

namespace palpate {

/// Which of the wanted topics (empty: all) the log holds. Throws std::runtime_error if one does not exist, or the file
/// is no log.
std::set<std::string> topics_in(const std::filesystem::path& log, const std::vector<std::string>& wanted = {});

/// Puts samples of a log on a bus.
class LogSender {
 public:
  LogSender(Bus& bus, const std::set<std::string>& topics);
  ~LogSender();

  /// Gives discovery a moment; true once every topic has a reader.
  bool wait_for_readers(std::chrono::nanoseconds patience) const;
  /// False if the sample is of another topic, or is not valid, or the bus refuses it. The times inside, which say when
  /// something happened, are moved by as much as the sample itself: to `now` [ns].
  bool send(const LogEvent& event, std::int64_t now);

 private:
  struct Outlets;
  std::unique_ptr<Outlets> outlets_;
};

}  // namespace palpate
