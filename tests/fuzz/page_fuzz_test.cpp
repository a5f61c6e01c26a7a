// What a hostile page may send: messages with numbers that cannot be, too short and too long ones, requests for any
// path under any name. They are read within their bounds, or refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "tests/fuzz/rounds.hpp"
#include "web_node/door.hpp"
#include "web_node/protocol.hpp"

namespace palpate {
namespace {

std::string some_bytes(std::size_t most, std::mt19937& random) {
  std::string bytes(random() % (most + 1), '\0');
  for (char& c : bytes) c = static_cast<char>(random());
  return bytes;
}

/// Most often of a right length and kind, with numbers where programs break.
std::string some_message(std::mt19937& random) {
  if (random() % 4 == 0) return some_bytes(2 * web::kMaxBytesSaid, random);
  const bool sample = random() % 4 != 0;
  std::string bytes(sample ? 32 : 8, '\0');
  bytes[0] = static_cast<char>(sample ? 1 : random() % 7);
  bytes[1] = static_cast<char>(random() % 3 == 0 ? random() : 0);
  const std::uint32_t number =
      random() % 2 ? random() : static_cast<std::uint32_t>(testing::any_of(testing::kExtremeIntegers, random));
  std::memcpy(&bytes[4], &number, 4);
  for (std::size_t at = 8; at < bytes.size(); at += 4) {
    const bool plain = random() % 8 != 0;
    const auto value = static_cast<float>(plain ? 1e-9 * random() : testing::any_of(testing::kExtremeNumbers, random));
    std::memcpy(&bytes[at], &value, 4);
  }
  return bytes;
}

TEST(PageFuzz, WhatAPageSaysIsWithinItsBoundsOrRefused) {
  std::mt19937 random(5);
  int read = 0, done = 0;
  testing::fuzz(200'000, 2, [&](int round) {
    const std::string bytes = some_message(random);
    const std::optional<web::Said> said = web::decode(bytes);
    ++done;
    if (!said) return;
    ++read;
    SCOPED_TRACE(fmt::format("round {}", round));
    ASSERT_EQ(bytes.size(), said->kind == web::Said::sample ? 32u : 8u);
    ASSERT_TRUE(said->kind >= web::Said::sample && said->kind <= web::Said::rest);
    if (said->kind != web::Said::sample) return;
    const web::Sample& s = said->motion;
    ASSERT_GT(s.number, 0u);
    ASSERT_LE(s.tip.cwiseAbs().maxCoeff(), 10);
    ASSERT_TRUE(std::isfinite(s.roll + s.grip) && s.pedal >= 0 && s.pedal <= 1);
  });
  fmt::print("{} messages, {} of them read\n", done, read);
  EXPECT_GT(read, 0);
  EXPECT_LT(read, done);
}

/// Pieces of what a request may ask for, so that many come near to what is right.
std::string some_text(std::mt19937& random) {
  static const std::array<const char*, 14> pieces{"/",   "",      "live",      "0123456789abcdef", "?",  ":",
                                                  "]",   "[::1]", "127.0.0.1", "localhost",        "..", "http://",
                                                  "%00", "//"};
  std::string text;
  for (unsigned more = random() % 6; more > 0; --more)
    text += random() % 6 == 0 ? some_bytes(20, random) : testing::any_of(pieces, random);
  return text;
}

TEST(PageFuzz, OnlyWhoKnowsTheSecretComesIn) {
  std::mt19937 random(6);
  const std::string secret = "0123456789abcdef";
  const web::Door guarded(secret, false), local("", true);
  testing::fuzz(200'000, 2, [&](int) {
    const std::string target = some_text(random), host = some_text(random);
    const std::string_view inside = guarded.path(target, host);
    ASSERT_TRUE(inside.empty() || target.starts_with("/" + secret + "/")) << target;
    const std::string_view here = local.path(target, host);
    const bool own = host.starts_with("127.0.0.1") || host.starts_with("localhost") || host.starts_with("[::1]");
    ASSERT_TRUE(here.empty() || own) << host;
    ASSERT_TRUE(!web::Door::same_origin(target, host) || target.ends_with("://" + host)) << target;
  });
}

}  // namespace
}  // namespace palpate
