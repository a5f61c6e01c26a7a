#include "web_node/protocol.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

namespace palpate::web {
namespace {

template <class T>
T at(const std::string& bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

std::string sample_bytes(std::uint32_t number, std::array<float, 6> rest, std::uint8_t kind = Said::sample) {
  std::string bytes(32, '\0');
  bytes[0] = static_cast<char>(kind);
  bytes[1] = 2;
  std::memcpy(bytes.data() + 4, &number, 4);
  std::memcpy(bytes.data() + 8, rest.data(), 24);
  return bytes;
}

/// Positions of body `b` as a page computes them.
std::vector<Eigen::Vector3f> unpack(const std::string& bytes, std::size_t place) {
  std::vector<Eigen::Vector3f> out(at<std::uint32_t>(bytes, place));
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[i][static_cast<int>(axis)] =
          at<float>(bytes, place + 4 + 4 * axis) +
          at<float>(bytes, place + 16 + 4 * axis) * at<std::uint16_t>(bytes, place + 32 + 6 * i + 2 * axis);
  return out;
}

TEST(WebProtocol, PositionsAreWrongByHalfAStepAtMost) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-0.15f, 0.2f);
  std::vector<Eigen::Vector3f> body(500);
  for (auto& p : body) p = {place(random), 0.1f * place(random), 0.03f};  // flat along z
  Frame frame;
  frame.bodies = {body};
  const std::string bytes = encode(frame);
  const auto seen = unpack(bytes, 32);
  ASSERT_EQ(seen.size(), body.size());
  Eigen::Vector3f worst = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < body.size(); ++i) worst = worst.cwiseMax((seen[i] - body[i]).cwiseAbs());
  EXPECT_LE(worst.x(), 0.35f / 131070 + 1e-7f);
  EXPECT_LE(worst.y(), 0.035f / 131070 + 1e-7f);
  EXPECT_EQ(worst.z(), 0);
}

TEST(WebProtocol, AFrameHoldsItsToolsAndBodiesInOrder) {
  std::vector<FrameTool> tools(2);
  for (auto& part : tools[1].parts) part = Eigen::Isometry3f(Eigen::Translation3f(1, 2, 3));
  tools[1].force = {4, 5, 6};
  tools[1].sample = 77;
  const std::vector<Eigen::Vector3f> one(3, Eigen::Vector3f::Ones()), two(5, Eigen::Vector3f::Zero());
  const std::string bytes =
      encode({.topology = 8, .number = 9, .sense_s = 1.5, .latency_ms = 2, .tools = tools, .bodies = {one, two}});
  EXPECT_EQ(at<std::uint32_t>(bytes, 0), static_cast<std::uint32_t>(Kind::frame));
  EXPECT_EQ(at<std::uint32_t>(bytes, 4), 8u);
  EXPECT_EQ(at<double>(bytes, 8), 1.5);
  EXPECT_EQ(at<std::uint32_t>(bytes, 16), 9u);
  EXPECT_EQ(at<std::uint16_t>(bytes, 20), 2u);
  EXPECT_EQ(at<std::uint16_t>(bytes, 22), 2u);
  const std::size_t second = 32 + 192;
  EXPECT_EQ(at<float>(bytes, second + 4 * 3), 1);  // first row ends with x
  EXPECT_EQ(at<float>(bytes, second + 144), 4);
  EXPECT_EQ(at<std::uint32_t>(bytes, second + 164), 77u);
  const std::size_t bodies = 32 + 2 * 192;
  EXPECT_EQ(unpack(bytes, bodies).size(), 3u);
  EXPECT_EQ(unpack(bytes, bodies + 32 + 20), std::vector<Eigen::Vector3f>(5, Eigen::Vector3f::Zero()));
}

TEST(WebProtocol, ArraysLieBesideTheirJson) {
  Container container;
  const std::vector<std::array<int, 3>> triangles{{1, 2, 3}};
  const std::vector<Eigen::Vector3f> points{{4, 5, 6}, {7, 8, 9}};
  const nlohmann::json json{{"first", container.add(triangles)}, {"second", container.add(points)}};
  const std::string bytes = container.finish(Kind::scenery, json);
  const auto length = at<std::uint32_t>(bytes, 4);
  EXPECT_EQ(length % 4, 0u);
  const auto told = nlohmann::json::parse(bytes.substr(8, length));
  EXPECT_EQ(told["second"]["count"], 6);
  EXPECT_EQ(at<float>(bytes, 8 + length + told["second"]["at"].get<std::size_t>() + 20), 9);
  EXPECT_EQ(at<std::int32_t>(bytes, 8 + length), 1);
}

TEST(WebProtocol, ArraysOfBytesLeaveTheNextWhereNumbersMayLie) {
  Container container;
  const std::vector<int> pieces{-1, 2};
  const nlohmann::json json{{"image", container.add_bytes("\x89PNG\n")}, {"pieces", container.add_integers(pieces)}};
  const std::string bytes = container.finish(Kind::scenery, json);
  const auto length = at<std::uint32_t>(bytes, 4);
  const auto told = nlohmann::json::parse(bytes.substr(8, length));
  EXPECT_EQ(told["image"]["type"], "u8");
  EXPECT_EQ(told["image"]["count"], 5);
  const auto second = told["pieces"]["at"].get<std::size_t>();
  EXPECT_EQ(second % 4, 0u);
  EXPECT_EQ(told["pieces"]["type"], "i32");
  EXPECT_EQ(at<std::int32_t>(bytes, 8 + length + second), -1);
}

TEST(WebProtocol, ASampleIsRead) {
  const auto said = decode(sample_bytes(5, {0.1f, 0.2f, -0.3f, 1, 0.5f, 1}));
  ASSERT_TRUE(said);
  EXPECT_EQ(said->kind, Said::sample);
  EXPECT_EQ(said->tool, 2);
  EXPECT_EQ(said->motion.number, 5u);
  EXPECT_NEAR((said->motion.tip - Eigen::Vector3d(0.1, 0.2, -0.3)).norm(), 0, 1e-7);
  EXPECT_EQ(said->motion.pedal, 1);
}

TEST(WebProtocol, WhatIsNoMessageIsRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(decode(""));
  EXPECT_FALSE(decode(std::string(7, '\2')));
  EXPECT_FALSE(decode(std::string(8, '\0')));                                 // no such kind
  EXPECT_FALSE(decode(std::string(1, Said::sample) + std::string(7, '\0')));  // too short for a sample
  EXPECT_FALSE(decode(sample_bytes(1, {0, 0, 0, 0, 0, 0}, Said::take)));
  EXPECT_FALSE(decode(sample_bytes(0, {0, 0, 0, 0, 0, 0})));
  EXPECT_FALSE(decode(sample_bytes(1, {nan, 0, 0, 0, 0, 0})));
  EXPECT_FALSE(decode(sample_bytes(1, {0, inf, 0, 0, 0, 0})));
  EXPECT_FALSE(decode(sample_bytes(1, {0, 0, 11, 0, 0, 0})));
  EXPECT_FALSE(decode(sample_bytes(1, {0, 0, 0, 100, 0, 0})));
  EXPECT_FALSE(decode(sample_bytes(1, {0, 0, 0, 0, 0, 2})));
  EXPECT_FALSE(decode(sample_bytes(1, {0, 0, 0, 0, nan, 0})));
  std::string reserved = sample_bytes(1, {0, 0, 0, 0, 0, 0}), of_a_tool(8, '\0');
  ASSERT_TRUE(decode(reserved));
  reserved[3] = 1;
  EXPECT_FALSE(decode(reserved));
  for (const std::uint8_t kind : {Said::taken, Said::rest}) {
    of_a_tool[0] = static_cast<char>(kind);
    of_a_tool[1] = 0;
    EXPECT_TRUE(decode(of_a_tool));
    of_a_tool[1] = 1;
    EXPECT_FALSE(decode(of_a_tool));
  }
}

TEST(WebProtocol, AnyBytesAreReadOrRefused) {
  std::mt19937 random(7);
  for (int i = 0; i < 200'000; ++i) {
    std::string bytes(random() % 40, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    if (random() % 2 && !bytes.empty()) bytes[0] = static_cast<char>(1 + random() % 6);
    const auto said = decode(bytes);
    ASSERT_TRUE(!said || said->kind != Said::sample || said->motion.tip.allFinite());
  }
}

}  // namespace
}  // namespace palpate::web
