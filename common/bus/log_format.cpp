#include "common/bus/log_format.hpp"

#include <zlib.h>

#include <set>
#include <sstream>

#include "common/bus/codec_visitors.hpp"
#include "idl/topics.hpp"

namespace palpate {
namespace {

std::multiset<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::multiset<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.insert(line);
  return lines;
}

}  // namespace

template <class Visitor, class Header>
requires std::same_as<std::remove_const_t<Header>, LogHeader>
void fields(Visitor& visit, Header& h) {
  visit("scene_hash", h.scene_hash);
  visit("scene", h.scene);
  visit("schema", h.schema);
  visit("version", h.version);
  visit("code_path", h.code_path);
  visit("host", h.host);
  visit("start_wall_ns", h.start_wall_ns);
  visit("start_monotonic_ns", h.start_monotonic_ns);
}
template <class Visitor, class File>
requires std::same_as<std::remove_const_t<File>, LogFile>
void fields(Visitor& visit, File& f) {
  visit("path", f.path);
  visit("hash", f.hash);
  visit("size", f.size);
  visit("content", f.content);
}
template <class Visitor, class Thinned>
requires std::same_as<std::remove_const_t<Thinned>, LogThinned>
void fields(Visitor& visit, Thinned& t) {
  visit("steps", t.steps);
}
template <class Visitor, class Footer>
requires std::same_as<std::remove_const_t<Footer>, LogFooter>
void fields(Visitor& visit, Footer& f) {
  visit("stop_monotonic_ns", f.stop_monotonic_ns);
  visit("written", f.written);
  visit("lost", f.lost);
  visit("error", f.error);
}

template void encode(const LogHeader&, Bytes&);
template bool decode(std::span<const std::uint8_t>, LogHeader&);
template void encode(const LogFile&, Bytes&);
template bool decode(std::span<const std::uint8_t>, LogFile&);
template void encode(const LogThinned&, Bytes&);
template bool decode(std::span<const std::uint8_t>, LogThinned&);
template void encode(const LogFooter&, Bytes&);
template bool decode(std::span<const std::uint8_t>, LogFooter&);

bool same_schema(const std::string& a, const std::string& b) {
  return lines_of(a) == lines_of(b);
}

std::string schema_text() {
  std::string text;
#define PALPATE_SCHEMA(M) text += schema_line<M>();
  PALPATE_PARTS(PALPATE_SCHEMA)
  PALPATE_MESSAGES(PALPATE_SCHEMA)
#undef PALPATE_SCHEMA
  topics::for_each([&](const auto& topic) {
    text.append("topic ").append(topic.name).append(" ").append(topic.message).append("\n");
  });
  return text;
}

namespace envelope {
namespace {

constexpr char kMagic[4] = {'P', 'L', 'P', 'T'};

std::uint32_t checksum(const std::string& channel, std::int64_t receive_ns, std::span<const std::uint8_t> payload) {
  uLong crc = crc32(0, reinterpret_cast<const Bytef*>(channel.data()), static_cast<uInt>(channel.size()));
  crc = crc32(crc, reinterpret_cast<const Bytef*>(&receive_ns), sizeof receive_ns);
  // A null pointer would mean "initial value" to zlib.
  if (!payload.empty()) crc = crc32(crc, payload.data(), static_cast<uInt>(payload.size()));
  return static_cast<std::uint32_t>(crc);
}

}  // namespace

Bytes wrap(const std::string& channel, std::int64_t receive_ns, std::span<const std::uint8_t> payload) {
  Bytes data;
  data.reserve(kSize + payload.size());
  detail::Encoder out{data};
  out.raw(kMagic, sizeof kMagic);
  out("", kVersion);
  out("", std::uint16_t{0});
  out("", checksum(channel, receive_ns, payload));
  out("", receive_ns);
  out.raw(payload.data(), payload.size());
  return data;
}

bool unwrap(const std::string& channel, std::span<const std::uint8_t> data, std::int64_t& receive_ns,
            std::span<const std::uint8_t>& payload) {
  if (data.size() < kSize || std::memcmp(data.data(), kMagic, sizeof kMagic) != 0) return false;
  detail::Decoder in{data.subspan(sizeof kMagic)};
  std::uint16_t found_version = 0, reserved = 0;
  std::uint32_t crc = 0;
  in("", found_version);
  in("", reserved);
  in("", crc);
  in("", receive_ns);
  payload = in.in;
  return in.good && found_version == kVersion && reserved == 0 && is_log_time(receive_ns) &&
         crc == checksum(channel, receive_ns, payload);
}

}  // namespace envelope
}  // namespace palpate
