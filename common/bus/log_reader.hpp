#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/log_format.hpp"
#include "idl/limits.hpp"

namespace palpate {

/// One recorded sample.
struct LogEvent {
  std::string channel;          ///< topic name
  std::int64_t receive_ns = 0;  ///< CLOCK_MONOTONIC of the recorder's host
  Bytes payload;                ///< encoded message
  std::uint64_t offset = 0;     ///< of the event in the file

  /// True if the event is of this topic and holds a complete valid message.
  template <class TopicOfM, class M>
  bool read(const TopicOfM& topic, M& message) const {
    return channel == topic.name && decode(payload, message) && valid(message);
  }
};

/// A stretch of the file that holds no readable event.
struct LogDamage {
  std::uint64_t offset = 0, bytes = 0;
  bool tail = false;  ///< reaches the end of the file: it was cut off or its recorder was killed
};

/// Reads a topic log from the beginning. Damage is stepped over: reading goes on at the next event that is
/// intact.
class LogReader {
 public:
  /// Throws std::runtime_error in one sentence if the file cannot be read, holds no event of a topic log, or
  /// was written with other messages than this program's.
  explicit LogReader(const std::filesystem::path& file);

  /// Of the log's first event; empty if that is damaged. Scene, its hash and the code path, which the recorder learns
  /// later, are filled in once the event of the scene is read.
  const LogHeader& header() const { return header_; }
  bool has_header() const { return has_header_; }

  /// The next sample; false at the end. Header, files, thinning and footer are not samples.
  bool next(LogEvent& event);
  /// The next file that goes along; samples before it are passed over. False at the end.
  bool next_file(LogFile& file);

  const std::vector<LogFile>& files() const { return files_; }  ///< passed so far by next(), without contents
  /// [steps] from one kept outcome of a step to the next, passed so far by next(); 0: the log leaves out nothing.
  std::uint64_t thinned_steps() const { return thinned_.steps; }
  const std::vector<LogDamage>& damage() const { return damage_; }    ///< found so far
  const std::optional<LogFooter>& footer() const { return footer_; }  ///< once read
  std::uint64_t size() const { return size_; }                        ///< [bytes] when opened
  std::uint64_t position() const { return position_; }                ///< [bytes] read so far
  /// "FILE: 2 damaged places, the first at byte 1234 (56 bytes)"; empty without damage.
  std::string damage_text() const;

 private:
  bool next_raw(LogEvent& event);
  void note_file(const LogEvent& event);
  void complete_header(const LogEvent& event);
  bool parse(std::uint64_t at, LogEvent& event, std::uint64_t& end);
  std::uint64_t find_sync(std::uint64_t from);
  const std::uint8_t* fetch(std::uint64_t at, std::size_t size);

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t size_ = 0, position_ = 0;
  Bytes window_;
  std::uint64_t window_at_ = 0;
  LogHeader header_;
  bool has_header_ = false;
  std::optional<LogFooter> footer_;
  LogThinned thinned_;
  std::vector<LogFile> files_;
  std::vector<LogDamage> damage_;
};

}  // namespace palpate
