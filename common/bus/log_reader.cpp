#include "common/bus/log_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "idl/topics.hpp"

namespace palpate {
namespace {

// The event of an LCM log, all numbers big-endian: sync word, i64 event number, i64 time [us since 1970],
// i32 length of the channel's name, i32 length of the data, name, data. liblcm stops reading at the first
// damage; this reader looks for the next sync word instead.
constexpr std::uint8_t kSyncWord[4] = {0xED, 0xA1, 0xDA, 0x01};
constexpr std::size_t kEventHead = 28;
constexpr std::size_t kMaxChannel = 63;
constexpr std::size_t kMaxData = 64u << 20;
constexpr std::size_t kWindowSize = 1u << 20;

std::uint32_t big_endian(const std::uint8_t* p) {
  return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | p[3];
}

// What is no regular file is not even opened: a pipe would wait for its other end.
std::FILE* open_log(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    throw std::runtime_error(file.string() + ": is not a file");
  std::FILE* opened = std::fopen(file.c_str(), "rb");
  if (!opened) throw std::runtime_error(fmt::format("{}: cannot be opened: {}", file.string(), std::strerror(errno)));
  return opened;
}

}  // namespace

LogReader::LogReader(const std::filesystem::path& file) : path_(file), file_(open_log(file)) {
  size_ = std::filesystem::file_size(file);

  LogEvent first;
  if (!next_raw(first)) {
    const bool foreign = size_ >= 4 && std::equal(kSyncWord, kSyncWord + 4, fetch(0, 4));
    throw std::runtime_error(fmt::format("{}: {}", file.string(),
                                         size_ == 0 ? "is empty"
                                         : foreign  ? "is an LCM log without a readable topic of this simulator"
                                                    : "is not a topic log"));
  }
  has_header_ = first.channel == kHeaderChannel && decode(first.payload, header_) &&
                is_log_time(header_.start_wall_ns) && is_log_time(header_.start_monotonic_ns);
  if (!has_header_) {
    header_ = {};
    position_ = 0;
    damage_.clear();
  }
  if (has_header_ && !same_schema(header_.schema, schema_text()))
    throw std::runtime_error(fmt::format("{}: was recorded by version {} with other messages than this program reads",
                                         file.string(), header_.version));
}

const std::uint8_t* LogReader::fetch(std::uint64_t at, std::size_t size) {
  if (at > size_ || size > size_ - at) return nullptr;
  if (at < window_at_ || at + size > window_at_ + window_.size()) {
    window_.resize(std::min<std::uint64_t>(std::max(size, kWindowSize), size_ - at));
    window_at_ = at;
    if (fseeko(file_.get(), static_cast<off_t>(at), SEEK_SET) != 0) window_.clear();
    window_.resize(std::fread(window_.data(), 1, window_.size(), file_.get()));
  }
  return size <= window_.size() && at + size <= window_at_ + window_.size() ? window_.data() + (at - window_at_)
                                                                            : nullptr;
}

bool LogReader::parse(std::uint64_t at, LogEvent& event, std::uint64_t& end) {
  const std::uint8_t* head = fetch(at, kEventHead);
  if (!head || !std::equal(kSyncWord, kSyncWord + 4, head)) return false;
  const std::uint32_t channel_length = big_endian(head + 20), data_length = big_endian(head + 24);
  if (channel_length == 0 || channel_length > kMaxChannel || data_length > kMaxData) return false;
  const std::size_t length = kEventHead + channel_length + data_length;
  const std::uint8_t* whole = fetch(at, length);
  if (!whole) return false;

  event.channel.assign(reinterpret_cast<const char*>(whole + kEventHead), channel_length);
  std::span<const std::uint8_t> payload;
  if (!envelope::unwrap(event.channel, {whole + kEventHead + channel_length, data_length}, event.receive_ns, payload))
    return false;
  event.payload.assign(payload.begin(), payload.end());
  event.offset = at;
  end = at + length;
  return true;
}

/// Position of the next sync word at or after `from`, the file's size if there is none.
std::uint64_t LogReader::find_sync(std::uint64_t from) {
  while (from + 4 <= size_) {
    const std::size_t chunk = std::min<std::uint64_t>(kWindowSize, size_ - from);
    const std::uint8_t* bytes = fetch(from, chunk);
    if (!bytes) break;
    const auto* found = std::search(bytes, bytes + chunk, kSyncWord, kSyncWord + 4);
    if (found != bytes + chunk) return from + static_cast<std::uint64_t>(found - bytes);
    from += chunk - 3;
    if (chunk < kWindowSize) break;
  }
  return size_;
}

bool LogReader::next_raw(LogEvent& event) {
  const std::uint64_t start = position_;
  std::uint64_t at = start, end = start;
  while (at < size_ && !parse(at, event, end)) at = find_sync(at + 1);
  if (at > start) damage_.push_back({start, at - start, at >= size_});
  position_ = at >= size_ ? size_ : end;
  return at < size_;
}

bool LogReader::next(LogEvent& event) {
  while (next_raw(event)) {
    if (event.channel == kFileChannel) note_file(event);
    if (event.channel == kThinnedChannel) decode(event.payload, thinned_);
    if (event.channel == kHeaderChannel || event.channel == kFileChannel || event.channel == kThinnedChannel) continue;
    if (header_.scene.empty()) complete_header(event);
    if (event.channel != kFooterChannel) return true;
    LogFooter footer;
    if (decode(event.payload, footer)) footer_ = footer;
  }
  return false;
}

void LogReader::note_file(const LogEvent& event) {
  LogFile file;
  if (!decode(event.payload, file)) return;
  file.content.clear();
  file.content.shrink_to_fit();
  files_.push_back(std::move(file));
}

bool LogReader::next_file(LogFile& file) {
  LogEvent event;
  while (next_raw(event))
    if (event.channel == kFileChannel && decode(event.payload, file)) return true;
  return false;
}

void LogReader::complete_header(const LogEvent& event) {
  SceneText scene;
  if (!event.read(topics::scene, scene)) return;
  header_.scene = scene.text;
  header_.scene_hash = scene.scene_hash;
  header_.code_path = scene.code_path;
}

std::string LogReader::damage_text() const {
  if (damage_.empty()) return {};
  if (damage_.size() == 1 && damage_.front().tail)
    return fmt::format("{}: the last event is cut off at byte {} ({} bytes unread)", path_.string(),
                       damage_.front().offset, damage_.front().bytes);
  return fmt::format("{}: {} damaged place{}, the first at byte {} ({} bytes)", path_.string(), damage_.size(),
                     damage_.size() == 1 ? "" : "s", damage_.front().offset, damage_.front().bytes);
}

}  // namespace palpate
