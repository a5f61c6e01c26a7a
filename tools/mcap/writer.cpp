#include "tools/mcap/writer.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace palpate {
namespace {

constexpr std::uint8_t kMagic[] = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::size_t kChunkBytes = 1u << 20;

enum Opcode : std::uint8_t {
  header = 1,
  footer,
  schema,
  channel_info,
  message,
  chunk,
  message_index,
  chunk_index,
  statistics = 0x0B,
  data_end = 0x0F
};

/// The content of a record; numbers are little-endian, as they lie in memory.
struct Fields {
  Bytes bytes;

  template <class T>
  requires std::is_integral_v<T> Fields& number(T value) {
    raw(&value, sizeof value);
    return *this;
  }
  Fields& text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size()));
    raw(value.data(), value.size());
    return *this;
  }
  template <class Pairs>
  Fields& pairs(const Pairs& values) {
    Fields inside;
    for (const auto& [key, value] : values) inside.number(key).number(value);
    number(static_cast<std::uint32_t>(inside.bytes.size()));
    raw(inside.bytes.data(), inside.bytes.size());
    return *this;
  }
  void raw(const void* from, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(from);
    bytes.insert(bytes.end(), first, first + size);
  }
};

void add_record(Bytes& to, Opcode opcode, const Fields& content, std::span<const std::uint8_t> more = {}) {
  Fields head;
  head.number(static_cast<std::uint8_t>(opcode)).number(std::uint64_t{content.bytes.size() + more.size()});
  to.insert(to.end(), head.bytes.begin(), head.bytes.end());
  to.insert(to.end(), content.bytes.begin(), content.bytes.end());
  to.insert(to.end(), more.begin(), more.end());
}

std::uint32_t checksum(const Bytes& bytes) {
  return static_cast<std::uint32_t>(crc32(0, bytes.data(), static_cast<uInt>(bytes.size())));
}

}  // namespace

void McapWriter::Times::add(std::uint64_t time) {
  first = std::min(first, time);
  last = std::max(last, time);
}

McapWriter::McapWriter(const std::filesystem::path& file)
    : path_(file), whole_(file), file_(std::fopen(whole_.handle().c_str(), "wb")) {
  require(file_ != nullptr);
  Bytes begin(std::begin(kMagic), std::end(kMagic));
  add_record(begin, header, Fields().text("").text("palpate " PALPATE_VERSION));
  put(begin);
}

void McapWriter::require(bool good) const {
  if (!good) throw std::runtime_error(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
}

void McapWriter::put(const Bytes& bytes) {
  require(std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size());
  at_ += bytes.size();
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& type, const std::string& encoding,
                                      const std::string& type_text, const std::string& message_encoding) {
  const std::uint16_t number = ++channel_count_;  // of the schema as well; 0 would be none
  Bytes records;
  add_record(records, schema, Fields().number(number).text(type).text(encoding).text(type_text));
  add_record(records, channel_info,
             Fields().number(number).number(number).text(topic).text(message_encoding).number(std::uint32_t{0}));
  channels_.insert(channels_.end(), records.begin(), records.end());
  chunk_.records.insert(chunk_.records.end(), records.begin(), records.end());
  statistics_.of_channel[number] = 0;
  return number;
}

void McapWriter::write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_time,
                       std::uint64_t publish_time, std::span<const std::uint8_t> data) {
  chunk_.index[channel].emplace_back(log_time, chunk_.records.size());
  add_record(chunk_.records, message, Fields().number(channel).number(sequence).number(log_time).number(publish_time),
             data);
  chunk_.times.add(log_time);
  statistics_.times.add(log_time);
  ++statistics_.messages;
  ++statistics_.of_channel[channel];
  if (chunk_.records.size() > kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.index.empty()) return;
  const std::uint64_t begin = at_, size = chunk_.records.size();
  Bytes record;
  add_record(record, chunk,
             Fields()
                 .number(chunk_.times.begin())
                 .number(chunk_.times.last)
                 .number(size)
                 .number(checksum(chunk_.records))
                 .text("")
                 .number(size),
             chunk_.records);
  put(record);
  const std::uint64_t chunk_end = at_;
  std::map<std::uint16_t, std::uint64_t> offsets;
  for (auto& [channel, places] : chunk_.index) {
    std::ranges::stable_sort(places);
    offsets[channel] = at_;
    Bytes index;
    add_record(index, message_index, Fields().number(channel).pairs(places));
    put(index);
  }
  add_record(chunk_indexes_, chunk_index,
             Fields()
                 .number(chunk_.times.begin())
                 .number(chunk_.times.last)
                 .number(begin)
                 .number(chunk_end - begin)
                 .pairs(offsets)
                 .number(at_ - chunk_end)
                 .text("")
                 .number(size)
                 .number(size));
  ++statistics_.chunks;
  chunk_ = {};
}

Bytes McapWriter::summary() const {
  Bytes bytes = channels_;
  add_record(bytes, statistics,
             Fields()
                 .number(statistics_.messages)
                 .number(channel_count_)
                 .number(std::uint32_t{channel_count_})
                 .number(std::uint32_t{0})
                 .number(std::uint32_t{0})
                 .number(statistics_.chunks)
                 .number(statistics_.times.begin())
                 .number(statistics_.times.last)
                 .pairs(statistics_.of_channel));
  bytes.insert(bytes.end(), chunk_indexes_.begin(), chunk_indexes_.end());
  return bytes;
}

void McapWriter::finish() {
  end_chunk();
  Bytes end;
  add_record(end, data_end, Fields().number(std::uint32_t{0}));
  put(end);
  // The checksum covers the summary and the footer up to itself.
  Bytes last = summary();
  Fields offsets;
  offsets.number(at_).number(std::uint64_t{0});
  Fields head;
  head.number(static_cast<std::uint8_t>(footer)).number(std::uint64_t{offsets.bytes.size() + sizeof(std::uint32_t)});
  last.insert(last.end(), head.bytes.begin(), head.bytes.end());
  last.insert(last.end(), offsets.bytes.begin(), offsets.bytes.end());
  Fields sum;
  sum.number(checksum(last));
  last.insert(last.end(), sum.bytes.begin(), sum.bytes.end());
  last.insert(last.end(), std::begin(kMagic), std::end(kMagic));
  put(last);
  require(std::fflush(file_.get()) == 0);
  whole_.commit();
}

}  // namespace palpate
