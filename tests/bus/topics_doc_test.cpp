#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "common/bus/fields.hpp"
#include "idl/topics.hpp"

/// docs/topics.md shows the table of idl/topics.hpp.
namespace palpate {
namespace {

std::string for_recorders(const Qos& qos) {
  return qos.recorder_depth > 0 ? fmt::format("; {} for recorders", qos.recorder_depth) : "";
}

std::string table() {
  std::string text =
      "| topic | message | delivery | kept per key | late joiners | rate | writer | readers | content |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  topics::for_each([&](const auto& t) {
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} | {} | {} | {} |\n", t.name, t.message,
                        t.qos.reliable ? "reliable" : "best effort",
                        t.qos.depth == keep_all ? "all" : std::to_string(t.qos.depth) + for_recorders(t.qos),
                        !t.qos.transient_local    ? "-"
                        : t.qos.depth == keep_all ? "get all"
                                                  : "get the newest",
                        t.rate, t.writer, t.readers, t.description);
  });
  return text;
}

TEST(Topics, TheDocumentShowsTheTable) {
  std::ifstream in(std::string(PALPATE_SOURCE_DIR) + "/docs/topics.md");
  std::stringstream document;
  document << in.rdbuf();
  EXPECT_NE(document.str().find(table()), std::string::npos) << "docs/topics.md should contain\n" << table();
}

TEST(Topics, EachRowNamesItsMessageType) {
  topics::for_each([]<class M>(const Topic<M>& t) {
    EXPECT_STREQ(t.message, name_of(static_cast<const M*>(nullptr)));
    EXPECT_EQ(std::string(t.name).substr(0, 8), "palpate/");
    EXPECT_TRUE(t.qos.depth >= 1 || (t.qos.depth == keep_all && t.qos.transient_local)) << t.name;
  });
}

}  // namespace
}  // namespace palpate
