#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::text_of;

/// A kind of tissue: its folder below common/models, the name that scene files call it by, and its type.
struct Kind {
  std::string folder, name, spec;
};

/// Those of the table of kinds.
std::vector<Kind> kinds() {
  const fs::path models = fs::path(PALPATE_SOURCE) / "common/models";
  const std::string table = text_of(models / "body.hpp");
  const std::regex include(R"-(#include "common/models/(\w+)/spec\.hpp")-");
  const std::regex row(R"-(struct (\w+) [^}]*kKind = "(\w+)")-");
  std::vector<Kind> all;
  for (std::sregex_iterator at(table.begin(), table.end(), include), end; at != end; ++at) {
    const std::string spec = text_of(models / (*at)[1].str() / "spec.hpp");
    std::smatch found;
    if (std::regex_search(spec, found, row)) all.push_back({(*at)[1], found[2], found[1]});
  }
  return all;
}

/// Sources that work with kinds of their own choice.
const std::set<std::string> kPermitted{
    "tools/rig",        // example bodies of known kinds for the next two, tests and benchmarks
    "tools/study",      // measures the methods of known kinds against references
    "tools/stability",  // stiff and extreme cases of known kinds
    "tools/generate",   // makes the meshes and motions of the scenes that come with the project
};

/// What of a source names a kind, or asks a body whether it is something.
std::vector<std::string> names_in(const std::string& text, const std::vector<Kind>& kinds) {
  std::vector<std::string> found;
  const auto look = [&](const std::string& pattern) {
    std::smatch match;
    if (std::regex_search(text, match, std::regex(pattern))) found.push_back(match[0]);
  };
  look(R"(\b(as|holds_alternative)<\w*Spec>)");
  for (const Kind& kind : kinds) {
    look("\\b" + kind.spec + "\\b");
    look("\"" + kind.name + "\"");
    look("common/models/" + kind.folder + "/");
  }
  return found;
}

TEST(Kinds, NoSourceOutsideTheModelsNamesAKindOfTissue) {
  const std::vector<Kind> all = kinds();
  ASSERT_GE(all.size(), 6u);
  int files = 0;
  for (const char* top : {"common", "haptic_node", "deform_node", "render_node", "tools", "idl"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(PALPATE_SOURCE) / top)) {
      const std::string extension = entry.path().extension(), file = fs::relative(entry.path(), PALPATE_SOURCE);
      if (extension != ".cpp" && extension != ".hpp") continue;
      if (file.starts_with("common/models/") || kPermitted.contains(fs::path(file).parent_path())) continue;
      ++files;
      for (const std::string& name : names_in(text_of(entry.path()), all)) ADD_FAILURE() << file << " names " << name;
    }
  EXPECT_GT(files, 250);
}

TEST(Kinds, ANameIsFoundInCodeAndInText) {
  const std::vector<Kind> kinds{{"foam", "soft_foam", "FoamSpec"}};
  EXPECT_TRUE(names_in("std::visit([](const auto& spec) { return owner(spec); }, body);", kinds).empty());
  EXPECT_EQ(names_in("if (as<SolidSpec>(body)) return;", kinds).size(), 1u);
  EXPECT_EQ(names_in("void check(const FoamSpec& body);", kinds).size(), 1u);
  EXPECT_EQ(names_in("if (kind_of(body) == \"soft_foam\") return;", kinds).size(), 1u);
  EXPECT_EQ(names_in("#include \"common/models/foam/part.hpp\"", kinds).size(), 1u);
}

}  // namespace
}  // namespace palpate
