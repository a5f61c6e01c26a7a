#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "idl/fields.hpp"
#include "idl/topics.hpp"

/// docs/topics.md shows the table of idl/palpate.idl.
namespace palpate {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Topics, TheDocumentShowsTheTable) {
  const std::string page = text_of(PALPATE_SOURCE_DIR "/docs/topics.md"), table = text_of(PALPATE_TOPICS_TABLE);
  const std::size_t begin = page.find("<!-- topics: begin"), end = page.find("<!-- topics: end -->");
  ASSERT_TRUE(begin < end && end != page.npos);
  EXPECT_EQ(page.substr(page.find('\n', begin) + 2, table.size() + 1), table + "\n")
      << "run idl/generate.py idl/palpate.idl --page docs/topics.md";
  EXPECT_EQ(page.find('\n', begin) + 2 + table.size() + 1, end) << "there is more between the marks than the table";
}

TEST(Topics, EachRowNamesItsMessageType) {
  topics::for_each([]<class M>(const Topic<M>& t) {
    EXPECT_STREQ(t.message, name_of(static_cast<const M*>(nullptr)));
    EXPECT_EQ(std::string(t.name).substr(0, 8), "palpate/");
    EXPECT_TRUE(t.qos.depth >= 1 || (t.qos.depth == kKeepAll && t.qos.transient_local)) << t.name;
  });
}

}  // namespace
}  // namespace palpate
