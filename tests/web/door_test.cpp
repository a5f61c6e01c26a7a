#include "web_node/door.hpp"

#include <gtest/gtest.h>

namespace palpate::web {
namespace {

TEST(WebDoor, OnThisHostItAnswersToNamesOfThisHostAlone) {
  const Door door("", true);
  EXPECT_EQ(door.path("/main.js", "127.0.0.1:8080"), "/main.js");
  EXPECT_EQ(door.path("/", "localhost:8080"), "/");
  EXPECT_EQ(door.path("/?x=1", "[::1]:8080"), "/");
  EXPECT_EQ(door.path("/", "evil.example:8080"), "");
  EXPECT_EQ(door.path("/", ""), "");
  EXPECT_EQ(door.path("x", "localhost"), "");
}

TEST(WebDoor, ElsewhereItAsksForTheSecret) {
  const std::string secret = random_secret();
  const Door door(secret, false);
  EXPECT_EQ(door.path("/" + secret + "/live", "10.0.0.3:8080"), "/live");
  EXPECT_EQ(door.path("/" + secret + "/", "a"), "/");
  EXPECT_EQ(door.path("/" + secret, "a"), "");
  EXPECT_EQ(door.path("/", "a"), "");
  EXPECT_EQ(door.path("/live", "a"), "");
  EXPECT_EQ(door.path("/" + random_secret() + "/live", "a"), "");
  EXPECT_EQ(door.path("/" + secret + "live", "a"), "");
}

TEST(WebDoor, SecretsAreLongAndDiffer) {
  EXPECT_EQ(random_secret().size(), 32u);
  EXPECT_NE(random_secret(), random_secret());
}

TEST(WebDoor, APageMayTalkToTheServerThatItCameFrom) {
  EXPECT_TRUE(Door::same_origin("http://127.0.0.1:8080", "127.0.0.1:8080"));
  EXPECT_TRUE(Door::same_origin("https://or.example", "or.example"));
  EXPECT_FALSE(Door::same_origin("http://evil.example", "127.0.0.1:8080"));
  EXPECT_FALSE(Door::same_origin("http://127.0.0.1:9090", "127.0.0.1:8080"));
  EXPECT_FALSE(Door::same_origin("", "127.0.0.1:8080"));
  EXPECT_FALSE(Door::same_origin("null", "null"));
  EXPECT_FALSE(Door::same_origin("://", ""));
}

}  // namespace
}  // namespace palpate::web
