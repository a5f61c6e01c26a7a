#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// Floor of every room, from the ground up, as common/layers.txt declares it.
std::map<std::string, int> floors(std::istream& lines) {
  std::map<std::string, int> of_room;
  int floor = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.starts_with("#")) continue;
    std::istringstream rooms(line);
    for (std::string room; rooms >> room;) of_room[room] = floor;
    ++floor;
  }
  return of_room;
}

/// The innermost room that a file stands in; empty if it stands in none.
std::string room_of(const std::string& file, const std::map<std::string, int>& floors) {
  std::string innermost;
  for (const auto& [room, floor] : floors)
    if ((file == room || file.starts_with(room + "/")) && room.size() > innermost.size()) innermost = room;
  return innermost;
}

/// One sentence for each include that does not lead downwards.
std::vector<std::string> faults(const std::string& file, const std::string& text,
                                const std::map<std::string, int>& floors) {
  static const std::regex own(R"-(#include "([^"]+/[^"]+)")-");
  std::vector<std::string> found;
  const std::string from = room_of(file, floors);
  if (from.empty()) return {file + " stands in no room"};
  for (std::sregex_iterator at(text.begin(), text.end(), own), end; at != end; ++at) {
    const std::string header = (*at)[1], to = room_of(header, floors);
    if (to.empty()) found.push_back(file + " includes " + header + ", which stands in no room");
    if (!to.empty() && to != from && floors.at(to) >= floors.at(from))
      found.push_back(file + " includes " + header + ", which does not stand below it");
  }
  return found;
}

TEST(Layers, EveryIncludeLeadsDownwards) {
  std::ifstream list(fs::path(PALPATE_SOURCE) / "common/layers.txt");
  const auto of_room = floors(list);
  int files = 0;
  for (const char* top :
       {"common", "haptic_node", "deform_node", "render_node", "web_node", "ros_bridge", "drivers", "tools", "idl"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(PALPATE_SOURCE) / top)) {
      const std::string kind = entry.path().extension();
      if (kind != ".cpp" && kind != ".hpp") continue;
      ++files;
      const std::string file = fs::relative(entry.path(), PALPATE_SOURCE);
      for (const std::string& fault : faults(file, testing::text_of(entry.path()), of_room)) ADD_FAILURE() << fault;
    }
  EXPECT_GT(files, 400);
}

TEST(Layers, AnArrowUpwardsOrAcrossIsFound) {
  std::istringstream list("low\nleft right\nhigh high/porch.hpp\n");
  const auto of_room = floors(list);
  EXPECT_TRUE(faults("high/a.cpp", "#include \"low/b.hpp\"\n#include \"high/c.hpp\"\n", of_room).empty());
  EXPECT_EQ(faults("low/a.cpp", "#include \"high/b.hpp\"\n", of_room).size(), 1u);
  EXPECT_EQ(faults("left/a.cpp", "#include \"right/b.hpp\"\n", of_room).size(), 1u);
  EXPECT_EQ(faults("left/a.cpp", "#include \"cellar/b.hpp\"\n", of_room).size(), 1u);
  EXPECT_EQ(faults("garden/a.cpp", "", of_room).size(), 1u);
}

}  // namespace
}  // namespace palpate
