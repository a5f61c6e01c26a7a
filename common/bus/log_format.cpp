#include "common/bus/log_format.hpp"

#include <zlib.h>

#include "idl/topics.hpp"

namespace palpate {

std::string schema_text() {
  std::string text = schema_line<NodalForce>() + schema_line<HeldContact>() + schema_line<LocalContact>() +
                     schema_line<LocalNode>() + schema_line<LocalTriangle>() + schema_line<ConsumedStep>() +
                     schema_line<ShellForce>();
#define PALPATE_SCHEMA(M) text += schema_line<M>();
  PALPATE_MESSAGES(PALPATE_SCHEMA)
#undef PALPATE_SCHEMA
  topics::for_each([&](const auto& topic) {
    text.append("topic ").append(topic.name).append(" ").append(topic.message).append("\n");
  });
  return text;
}

namespace envelope {
namespace {

constexpr char magic[4] = {'P', 'L', 'P', 'T'};

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
  data.reserve(size + payload.size());
  detail::Encoder out{data};
  out.raw(magic, sizeof magic);
  out("", version);
  out("", std::uint16_t{0});
  out("", checksum(channel, receive_ns, payload));
  out("", receive_ns);
  out.raw(payload.data(), payload.size());
  return data;
}

bool unwrap(const std::string& channel, std::span<const std::uint8_t> data, std::int64_t& receive_ns,
            std::span<const std::uint8_t>& payload) {
  if (data.size() < size || std::memcmp(data.data(), magic, sizeof magic) != 0) return false;
  detail::Decoder in{data.subspan(sizeof magic)};
  std::uint16_t found_version = 0, reserved = 0;
  std::uint32_t crc = 0;
  in("", found_version);
  in("", reserved);
  in("", crc);
  in("", receive_ns);
  payload = in.in;
  return in.good && found_version == version && reserved == 0 && crc == checksum(channel, receive_ns, payload);
}

}  // namespace envelope
}  // namespace palpate
