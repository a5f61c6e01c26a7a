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
  constexpr std::string_view include = "#include \"";
  std::vector<std::string> found;
  const std::string from = room_of(file, floors);
  if (from.empty()) return {file + " stands in no room"};
  for (std::size_t at = text.find(include); at != std::string::npos; at = text.find(include, at)) {
    at += include.size();
    const std::string header = text.substr(at, text.find('"', at) - at), to = room_of(header, floors);
    if (header.find('/') == std::string::npos) continue;
    if (to.empty()) found.push_back(file + " includes " + header + ", which stands in no room");
    if (!to.empty() && to != from && floors.at(to) >= floors.at(from))
      found.push_back(file + " includes " + header + ", which does not stand below it");
  }
  return found;
}

/// Libraries of common/, and what is linked to each of them.
struct Libraries {
  std::map<std::string, int> floors;  ///< of the folder that builds it, in the order of common/CMakeLists.txt
  std::vector<std::pair<std::string, std::string>> links;
  std::vector<std::string> from_elsewhere;  ///< sources that a folder takes from another

  /// `text`: a folder's CMakeLists.txt.
  void add(int floor, const std::string& text) {
    static const std::regex command(R"((add_library|target_link_libraries)\(\s*(\S+)([^)]*)\))");
    static const std::regex word(R"(\S+)");
    const std::sregex_iterator end;
    for (std::sregex_iterator at(text.begin(), text.end(), command); at != end; ++at) {
      const std::string name = (*at)[2], words = (*at)[3];
      const bool made = (*at)[1] == "add_library";
      if (made) floors[name] = floor;
      for (std::sregex_iterator w(words.begin(), words.end(), word); w != end; ++w) {
        if (made && w->str().starts_with("..")) from_elsewhere.push_back(w->str());
        if (!made) links.emplace_back(name, w->str());
      }
    }
  }
  /// One sentence for each link that leads upwards, and each source from elsewhere.
  std::vector<std::string> faults() const {
    std::vector<std::string> found;
    for (const std::string& source : from_elsewhere) found.push_back(source + " is not its folder's own");
    for (const auto& [from, to] : links)
      if (floors.contains(to) && floors.at(to) > floors.at(from)) found.push_back(from + " links upwards, to " + to);
    return found;
  }
};

TEST(Layers, EveryLibraryLinksDownwards) {
  const fs::path common = fs::path(PALPATE_SOURCE) / "common";
  const std::string order = testing::text_of(common / "CMakeLists.txt");
  static const std::regex folder(R"(add_subdirectory\((\w+)\))");
  Libraries libraries;
  int floor = 0;
  for (std::sregex_iterator at(order.begin(), order.end(), folder), end; at != end; ++at)
    libraries.add(floor++, testing::text_of(common / std::string((*at)[1]) / "CMakeLists.txt"));
  for (const std::string& fault : libraries.faults()) ADD_FAILURE() << fault;
  EXPECT_GT(libraries.floors.size(), 20u);
  EXPECT_GT(libraries.links.size(), 60u);
}

TEST(Layers, ALinkUpwardsAndASourceFromElsewhereAreFound) {
  Libraries libraries;
  libraries.add(0, "add_library(low STATIC a.cpp ../high/b.cpp)\ntarget_link_libraries(low\n  PUBLIC beside high)\n");
  libraries.add(1, "add_library(high STATIC c.cpp)\ntarget_link_libraries(high PRIVATE low fmt::fmt)\n");
  EXPECT_EQ(libraries.faults(),
            (std::vector<std::string>{"../high/b.cpp is not its folder's own", "low links upwards, to high"}));
}

TEST(Layers, EveryIncludeLeadsDownwards) {
  std::ifstream list(fs::path(PALPATE_SOURCE) / "common/layers.txt");
  const auto of_room = floors(list);
  int files = 0;
  for (const char* top : {"common", "haptic_node", "deform_node", "render_node", "web_node", "ros_bridge", "drivers",
                          "tools", "idl", "python"})
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
