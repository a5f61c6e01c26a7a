#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "common/scene/scene.hpp"

namespace palpate {
namespace {

/// The keys of docs/scene.md: below a heading "## `[[body]]` ...", the rows "| `young` | ...".
std::map<std::string, std::vector<std::string>> documented_keys() {
  std::ifstream stream(PALPATE_SOURCE_DIR "/docs/scene.md");
  std::map<std::string, std::vector<std::string>> tables;
  std::string table;
  for (std::string line; std::getline(stream, line);) {
    const auto quoted = [&](std::size_t from) { return line.substr(from, line.find('`', from) - from); };
    if (line.starts_with("## ")) table = line.starts_with("## `") ? quoted(4) : "";
    if (!table.empty() && line.starts_with("| `")) tables[table].push_back(quoted(3));
  }
  return tables;
}

TEST(SceneReference, ListsTheKeysThatTheParserKnows) {
  std::map<std::string, std::vector<std::string>> known;
  for (const DescribedTable& table : scene_keys().tables())
    for (const DescribedKey& key : table.keys) known[table.path.name()].push_back(key.name);
  EXPECT_EQ(documented_keys(), known);
}

}  // namespace
}  // namespace palpate
