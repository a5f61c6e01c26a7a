#include "common/bus/roles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
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

struct Cells {
  std::string writers, readers;
};

/// Writers and readers of each topic as the page shows them.
std::map<std::string, Cells> cells_of_the_page() {
  std::ifstream in(PALPATE_TOPICS_PAGE);
  std::map<std::string, Cells> rows;
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> cells{""};
    for (std::size_t at = 0, end; line.starts_with("| `") && (end = line.find(" | ", at)) != line.npos; at = end + 3)
      cells.push_back(line.substr(at, end - at));
    if (cells.size() == 10) rows[cells[1].substr(3, cells[1].size() - 4)] = {cells[8], cells[9]};
  }
  return rows;
}

/// The page's table as people read it, cell by cell: what each row's writers and readers come to.
TEST(BusRoles, FollowTheTableOfTopics) {
  const Names nodes{"haptic", "deform", "render", "web", "driver", "recorder"};
  std::map<std::string, Cells> page = cells_of_the_page();
  topics::for_each([&](const auto& topic) {
    ASSERT_TRUE(page.contains(topic.name)) << topic.name;
    const Cells& row = page[topic.name];
    const auto roles_in = [&](const std::string& cell) {
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
    Names expected_readers = roles_in(row.readers);
    expected_readers.insert("recorder");
    EXPECT_EQ(writers, roles_in(row.writers)) << topic.name;
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
