#pragma once
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/bus/codec.hpp"
#include "common/files/atomic_file.hpp"

namespace palpate {

/// Writes an MCAP file (mcap.dev, version 0): chunks without compression, each with its index, and a summary, so that
/// readers find topics and times without reading all.
class McapWriter {
 public:
  /// The file is there once finish() returns. Throws std::runtime_error if it cannot be written.
  explicit McapWriter(const std::filesystem::path& file);

  /// A topic, with the type of its messages; its number.
  std::uint16_t add_channel(const std::string& topic, const std::string& type, const std::string& encoding,
                            const std::string& type_text, const std::string& message_encoding);
  /// Times [ns] since 1970.
  void write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_time, std::uint64_t publish_time,
             std::span<const std::uint8_t> data);
  /// Throws std::runtime_error if something could not be written.
  void finish();

  std::uint64_t messages() const { return statistics_.messages; }

 private:
  struct Times {
    std::uint64_t first = UINT64_MAX, last = 0;
    void add(std::uint64_t time);
    std::uint64_t begin() const { return first == UINT64_MAX ? 0 : first; }
  };
  struct Chunk {
    Bytes records;
    Times times;
    std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> index;  ///< time and offset
  };
  struct Statistics {
    std::uint64_t messages = 0;
    std::uint32_t chunks = 0;
    Times times;
    std::map<std::uint16_t, std::uint64_t> of_channel;
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void require(bool good) const;  ///< throws std::runtime_error with the reason that errno has
  void put(const Bytes& bytes);
  void end_chunk();
  Bytes summary() const;

  std::filesystem::path path_;
  AtomicFile whole_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t at_ = 0;  ///< [bytes] written
  Bytes channels_;        ///< records of schemas and channels, which the summary repeats
  std::uint16_t channel_count_ = 0;
  Chunk chunk_;
  Bytes chunk_indexes_;
  Statistics statistics_;
};

}  // namespace palpate
