#include "common/bus/roles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "idl/topics.hpp"
#include "tools/keys/documents.hpp"

namespace palpate::testing {
namespace {

using Names = std::set<std::string>;

Names names(const std::vector<std::string>& list) {
  return {list.begin(), list.end()};
}

Names all_topics() {
  Names all;
  topics::for_each([&](const auto& topic) {
    all.insert(topic.name);
    if (topic.qos.recorder_depth > 0) all.insert(recorders_name(topic));
  });
  return all;
}

/// The table as roles read it, cell by cell: what each row's writer and readers come to.
TEST(BusRoles, FollowTheTableOfTopics) {
  const Names nodes{"haptic", "deform", "render", "driver", "recorder"};
  topics::for_each([&](const auto& topic) {
    const auto roles_in = [&](std::string cell) {
      if (cell == "who asked") cell = topics::clock_probe.writer;
      if (cell == "all") return nodes;
      Names found;
      for (const std::string& role : nodes)
        if (std::regex_search(cell, std::regex("\\b" + role + "\\b")) != cell.starts_with("all but"))
          found.insert(role);
      return found;
    };
    Names writers, readers;
    for (const std::string& role : nodes) {
      if (names(rights_of(role).writes).contains(topic.name)) writers.insert(role);
      if (names(rights_of(role).reads).contains(topic.name)) readers.insert(role);
    }
    Names expected_readers = roles_in(topic.readers);
    expected_readers.insert("recorder");
    EXPECT_EQ(writers, roles_in(topic.writer)) << topic.name;
    EXPECT_FALSE(writers.empty()) << topic.name;
    EXPECT_EQ(readers, expected_readers) << topic.name;
    const std::string own = recorders_name(topic);
    for (const std::string& role : nodes) {
      EXPECT_EQ(names(rights_of(role).writes).contains(own), topic.qos.recorder_depth > 0 && writers.contains(role))
          << own;
      EXPECT_EQ(names(rights_of(role).reads).contains(own), topic.qos.recorder_depth > 0 && role == "recorder") << own;
    }
  });
}

TEST(BusRoles, WhoWatchesReadsAllAndWritesNothingOfTheNodes) {
  EXPECT_EQ(rights_of("observer").writes, std::vector<std::string>{});
  EXPECT_EQ(names(rights_of("observer").reads), all_topics());
  EXPECT_EQ(rights_of("latency").writes, std::vector<std::string>{"palpate/latency_*"});
  EXPECT_EQ(names(rights_of("recorder").reads), all_topics());
  EXPECT_FALSE(names(rights_of("recorder").writes).contains("palpate/force_state"));
  EXPECT_EQ(names(rights_of("player").writes), all_topics());
  EXPECT_THROW(rights_of("surgeon"), std::runtime_error);
}

TEST(BusRoles, NoOtherNodeWritesWhatTheHandFeels) {
  for (const std::string& role : bus_roles()) {
    const bool writes = names(rights_of(role).writes).contains("palpate/force_state");
    EXPECT_EQ(writes, role == "haptic" || role == "player") << role;
  }
}

Names between(const std::string& text, const std::string& element) {
  const std::size_t from = text.find("<" + element + ">"), to = text.find("</" + element + ">");
  Names found;
  if (from == text.npos) return found;
  const std::string part = text.substr(from, to - from);
  const std::regex topic("<topic>([^<]*)</topic>");
  for (std::sregex_iterator at(part.begin(), part.end(), topic), end; at != end; ++at) found.insert((*at)[1]);
  return found;
}

TEST(BusRoles, PermissionsNameTheirRightsAndDenyTheRest) {
  for (const std::string& role : bus_roles()) {
    const std::string text = keys::permissions_document(role, "CN=x", rights_of(role), {0, 86400});
    EXPECT_EQ(between(text, "publish"), names(rights_of(role).writes)) << role;
    EXPECT_EQ(between(text, "subscribe"), names(rights_of(role).reads)) << role;
    EXPECT_EQ(text.find("<publish>") == text.npos, rights_of(role).writes.empty()) << role;
    EXPECT_NE(text.find("<default>DENY</default>"), text.npos);
    EXPECT_NE(text.find("<not_before>1970-01-01T00:00:00Z</not_before><not_after>1970-01-02T00:00:00Z</not_after>"),
              text.npos);
  }
}

TEST(BusRoles, GovernanceLeavesNothingOpen) {
  const std::string text = keys::governance_document();
  for (const char* element :
       {"discovery_protection_kind", "liveliness_protection_kind", "metadata_protection_kind", "data_protection_kind"})
    EXPECT_NE(text.find(std::string("<") + element + ">ENCRYPT<"), text.npos) << element;
  for (const char* element :
       {"enable_join_access_control", "enable_discovery_protection", "enable_liveliness_protection",
        "enable_read_access_control", "enable_write_access_control"})
    EXPECT_NE(text.find(std::string("<") + element + ">true<"), text.npos) << element;
  EXPECT_NE(text.find("<allow_unauthenticated_participants>false<"), text.npos);
  EXPECT_NE(text.find("<topic_expression>*<"), text.npos);
}

}  // namespace
}  // namespace palpate::testing
