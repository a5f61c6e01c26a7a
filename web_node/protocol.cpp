#include "web_node/protocol.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

static_assert(std::endian::native == std::endian::little);

namespace palpate::web {
namespace {

using Eigen::Vector3f;

template <class T>
void put(std::string& to, const T& value) {
  const auto* bytes = reinterpret_cast<const char*>(&value);
  to.append(bytes, sizeof value);
}

template <class T>
T get(std::string_view from, std::size_t at) {
  T value;
  std::memcpy(&value, from.data() + at, sizeof value);
  return value;
}

void pad(std::string& text, char with) {
  text.append((4 - text.size() % 4) % 4, with);
}

void put_tool(std::string& to, const FrameTool& tool) {
  for (const Eigen::Isometry3f& part : tool.parts)
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column) put(to, part.matrix()(row, column));
  for (int axis = 0; axis < 3; ++axis) put(to, tool.force[axis]);
  put(to, tool.grip_torque);
  for (const std::uint32_t word : {tool.flags, tool.sample, tool.holder, tool.asker}) put(to, word);
  for (const float number : {tool.roll, tool.grip, tool.pedal, 0.0f}) put(to, number);
}

void put_body(std::string& to, std::span<const Vector3f> position) {
  Vector3f low = Vector3f::Zero(), high = Vector3f::Zero();
  if (!position.empty()) low = high = position.front();
  for (const Vector3f& p : position) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vector3f step = (high - low) / 65535;
  put(to, static_cast<std::uint32_t>(position.size()));
  for (int axis = 0; axis < 3; ++axis) put(to, low[axis]);
  for (int axis = 0; axis < 3; ++axis) put(to, step[axis]);
  put(to, std::uint32_t{0});
  const Vector3f per = step.unaryExpr([](float s) { return s > 0 ? 1 / s : 0.0f; });
  for (const Vector3f& p : position)
    for (int axis = 0; axis < 3; ++axis)
      put(to, static_cast<std::uint16_t>(std::clamp((p[axis] - low[axis]) * per[axis] + 0.5f, 0.0f, 65535.0f)));
  pad(to, 0);
}

bool usable(const Sample& s) {
  return s.number > 0 && s.tip.allFinite() && s.tip.cwiseAbs().maxCoeff() <= 10 && std::abs(s.roll) <= 10 &&
         std::abs(s.grip) <= 10 && s.pedal >= 0 && s.pedal <= 1;
}

}  // namespace

nlohmann::json Container::append(const void* data, std::size_t bytes, std::size_t count, const char* type) {
  const std::size_t at = arrays_.size();
  arrays_.append(static_cast<const char*>(data), bytes);
  pad(arrays_, 0);
  return {{"at", at}, {"count", count}, {"type", type}};
}

nlohmann::json Container::add(std::span<const Vector3f> vectors) {
  return append(vectors.data(), vectors.size_bytes(), 3 * vectors.size(), "f32");
}

nlohmann::json Container::add(std::span<const std::array<int, 3>> triangles) {
  return append(triangles.data(), triangles.size_bytes(), 3 * triangles.size(), "u32");
}

nlohmann::json Container::add_numbers(std::span<const float> numbers) {
  return append(numbers.data(), numbers.size_bytes(), numbers.size(), "f32");
}

nlohmann::json Container::add_integers(std::span<const int> integers) {
  return append(integers.data(), integers.size_bytes(), integers.size(), "i32");
}

nlohmann::json Container::add_bytes(std::string_view bytes) {
  return append(bytes.data(), bytes.size(), bytes.size(), "u8");
}

std::string Container::finish(Kind kind, const nlohmann::json& json) const {
  std::string text = json.dump();
  pad(text, ' ');
  if (text.size() + arrays_.size() > 0x7fffffff) throw std::runtime_error("the scene is too large for a page");
  std::string bytes;
  put(bytes, kind);
  put(bytes, static_cast<std::uint32_t>(text.size()));
  return bytes + text + arrays_;
}

std::string encode(const Frame& frame) {
  std::string bytes;
  std::size_t nodes = 0;
  for (const auto& body : frame.bodies) nodes += body.size();
  bytes.reserve(64 + 192 * frame.tools.size() + 40 * frame.bodies.size() + 6 * nodes);
  put(bytes, Kind::frame);
  put(bytes, frame.topology);
  put(bytes, frame.sense_s);
  put(bytes, frame.number);
  put(bytes, static_cast<std::uint16_t>(frame.tools.size()));
  put(bytes, static_cast<std::uint16_t>(frame.bodies.size()));
  put(bytes, frame.latency_ms);
  put(bytes, std::uint32_t{0});
  for (const FrameTool& tool : frame.tools) put_tool(bytes, tool);
  for (const auto& body : frame.bodies) put_body(bytes, body);
  return bytes;
}

std::optional<Said> decode(std::string_view bytes) {
  if (bytes.size() != 8 && bytes.size() != 32) return {};
  Said said{};
  const auto kind = get<std::uint8_t>(bytes, 0);
  if (kind < Said::sample || kind > Said::rest || (kind == Said::sample) != (bytes.size() == 32)) return {};
  said.kind = static_cast<Said::Kind>(kind);
  said.tool = get<std::uint8_t>(bytes, 1);
  const bool of_no_tool = said.kind == Said::taken || said.kind == Said::rest;
  if (get<std::uint16_t>(bytes, 2) != 0 || (of_no_tool && said.tool != 0)) return {};
  said.number = get<std::uint32_t>(bytes, 4);
  if (said.kind != Said::sample) return said;
  Sample& s = said.motion;
  s.number = said.number;
  for (int axis = 0; axis < 3; ++axis) s.tip[axis] = get<float>(bytes, 8 + 4 * static_cast<std::size_t>(axis));
  s.roll = get<float>(bytes, 20);
  s.grip = get<float>(bytes, 24);
  s.pedal = get<float>(bytes, 28);
  return usable(s) ? std::optional(said) : std::nullopt;
}

}  // namespace palpate::web
