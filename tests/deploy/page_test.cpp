#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "tests/loopback/loopback_scene.hpp"

/// The pages and the script agree with what is built.
namespace palpate::testing {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(std::string(PALPATE_SOURCE) + "/" + file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::set<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

/// The first submatches of a pattern in a text.
std::set<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), regex), end; at != end; ++at) found.insert((*at)[1]);
  return found;
}

TEST(DeployPage, TheScriptBringsEveryFileThatASceneCanName) {
  auto named = matches(text_of("docs/scene.md"), R"(\| `(\w+)` \| path \|)");
  named.erase("file");  // of [record]: written, not read
  named.erase("keys");  // a folder, of which each host gets its own part
  ASSERT_GE(named.size(), 6u);
  const auto keys = matches(text_of("scripts/deploy.sh"), "keys=[^'\n]*'([^']*)'");
  ASSERT_EQ(keys.size(), 1u);
  EXPECT_EQ(named, matches(*keys.begin(), R"((\w+))"));
}

/// Debian packages of the libraries that a program itself asks for. Some are known to dpkg by the path that ldd gives,
/// some by what it links to, and some below /usr.
std::set<std::string> packages_of(const std::string& program) {
  std::string said;
  run_command(fmt::format("readelf -d {0} | sed -n 's/.*NEEDED.*\\[\\(.*\\)\\]/\\1/p' | while read -r name; do "
                          "file=$(ldd {0} | awk -v name=\"$name\" '$1 == name {{print $3}}'); echo \"$file\" "
                          "\"$(readlink -f \"$file\")\" \"/usr$file\"; done | "
                          "xargs dpkg-query -S 2>/dev/null | cut -d: -f1",
                          program),
              &said);
  return words_of(said);
}

TEST(DeployPage, ThePackagesOfEachNodeAreThoseOfItsLibraries) {
  if (run_command("command -v dpkg-query readelf") != 0) GTEST_SKIP() << "dpkg-query or readelf is not there";
  const std::string page = text_of("docs/deploy.md");
  for (const std::string node : {"haptic_node", "deform_node", "render_node", "palpate", "libpalpate_gmsh.so"}) {
    const auto row = matches(page, "\\| `" + node + "` \\| `([^`]*)`");
    ASSERT_EQ(row.size(), 1u) << node;
    const auto listed = words_of(*row.begin());
    const bool is_program = !node.ends_with(".so");
    const auto needed = packages_of(program(is_program ? node : "../lib/palpate/" + node));
    EXPECT_GE(needed.size(), is_program ? 6u : 2u) << node;
    for (const std::string& package : needed) {
      const bool everywhere = package == "libc6" || package == "libgcc-s1" || package == "libstdc++6";
      const bool sanitizer = package.find("san") != std::string::npos;  // of the test's own build
      EXPECT_TRUE(everywhere || sanitizer || listed.contains(package)) << node << " needs " << package;
    }
  }
}

}  // namespace
}  // namespace palpate::testing
