#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "common/bus/log_format.hpp"

namespace palpate {

/// How a log writer fares.
struct LogStatus {
  std::uint64_t written = 0;  ///< events on their way to the disk and not known to be lost
  std::uint64_t lost = 0;     ///< events that could not be written or queued
  std::uint64_t bytes = 0;    ///< size of the file
  std::string error;          ///< last reason for a loss: "no space left", …; empty if none
};

/// What a log writer does with an event while too many wait for the disk: after three seconds without room it is lost,
/// and so are all that follow until there is room; or it waits for as long as it takes.
enum class WhenFull { lose, wait };

/// When a log takes the place of a file of its name that holds something.
enum class Naming {
  at_once,
  later  ///< at give_name(), until which that stays as it is
};

/// Writes an LCM event log from a thread of its own: write() waits for the disk only where as much as may wait does.
/// When the disk is full or stands, events are counted as lost and writing is tried again each second; what was written
/// stays readable.
class LogWriter {
 public:
  static constexpr std::size_t kQueueLimit = 64u << 20;  ///< [bytes] that wait for the disk at most

  /// Creates the file. Throws std::runtime_error if that fails.
  explicit LogWriter(const std::filesystem::path& file, std::size_t queue_bytes = kQueueLimit);
  /// The same with the header in it before the file has its name: at no moment is there a file that cannot be read.
  /// Throws also if another writer has it.
  LogWriter(const std::filesystem::path& file, const LogHeader& header, WhenFull when_full = WhenFull::lose,
            Naming naming = Naming::at_once);
  ~LogWriter();  ///< finish() without a footer if it was not called

  /// Appends an event; receive_ns is CLOCK_MONOTONIC. Call from one thread.
  void write_payload(const std::string& channel, std::int64_t receive_ns, const Bytes& payload);

  template <class M>
  void write(const std::string& channel, std::int64_t receive_ns, const M& message) {
    Bytes payload;
    encode(message, payload);
    write_payload(channel, receive_ns, payload);
  }

  /// Takes its name, where it has not. Throws std::runtime_error if that fails.
  void give_name();
  bool has_name() const;  ///< without it nothing stays of the log

  /// Writes the footer and what is queued, and closes the file.
  LogStatus finish();
  LogStatus status() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate
