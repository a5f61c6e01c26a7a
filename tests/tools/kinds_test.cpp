#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using testing::text_of;

/// A kind of something: where its files lie, the name that scene files call it by, and its type.
struct Kind {
  std::string files, name, spec;
};

/// A table of kinds, and who may name them.
struct Table {
  std::string file;   ///< includes their specs
  std::size_t least;  ///< of kinds in it
  std::string homes;  ///< regular expression of files that may name any; a kind's own folder names that kind
  /// Folders of sources that work with kinds of their own choice.
  std::set<std::string> permitted;
  std::set<std::string> words = {};  ///< names that stand in quotes for something else, too
  std::string question = {};         ///< regular expression that asks one of them what it is, by a base; has "Spec>"
  bool classes = false;              ///< nor may they name a class that is called after a kind, but messages in words
};

void PrintTo(const Table& table, std::ostream* out) {
  *out << table.file;
}

const std::vector<Table> kTables{
    {.file = "common/models/body.hpp",
     .least = 6,
     .homes = R"(common/models/(body|marked_to_resect)\..*)",
     .permitted =
         {
             "tools/rig",        // example bodies of known kinds for the next two, tests and benchmarks
             "tools/study",      // measures the methods of known kinds against references
             "tools/stability",  // stiff and extreme cases of known kinds
             "tools/generate",   // makes the meshes and motions of the scenes that come with the project
             "tools/mesh",       // says what a mesh would cost as a body of a known kind
             "tools/organ",      // the same of the meshes that it makes
         },
     .words = {"CatheterState"},
     .question = R"(\b(as|holds_alternative)<\w*Spec>)",
     .classes = true},
    {.file = "common/tool/devices/device_spec.hpp",
     .least = 3,
     .homes = "common/(tool/)?devices/.*",
     .permitted = {"tools/generate"},
     .words = {"log"}},
    {.file = "common/tool/ends/end_spec.hpp",
     .least = 2,
     .homes = "common/(tool|sim)/ends/.*",
     .permitted = {"tools/rig", "tools/study", "tools/stability", "tools/generate"}},
};

/// Those of a table, one for each header with a kKind that it includes.
std::vector<Kind> kinds_in(const Table& table) {
  const fs::path root = PALPATE_SOURCE;
  const std::string text = text_of(root / table.file);
  const std::regex include(R"-(#include "(common/[^"]+)")-");
  const std::regex row(R"-(struct (\w+) [^}]*kKind = "(\w+)")-");
  std::vector<Kind> all;
  for (std::sregex_iterator at(text.begin(), text.end(), include), end; at != end; ++at) {
    const fs::path header = (*at)[1].str();
    const std::string spec = text_of(root / header);
    std::smatch found;
    if (!std::regex_search(spec, found, row)) continue;
    const bool has_folder = header.filename() == "spec.hpp";
    all.push_back({has_folder ? header.parent_path().string() + "/" : header.string(), found[2], found[1]});
  }
  return all;
}

/// "Foam" of FoamSpec.
std::string stem_of(const Kind& kind) {
  return kind.spec.substr(0, kind.spec.rfind("Spec"));
}

/// What of a source names one of the table's kinds, or asks something whether it is one.
std::vector<std::string> names_in(const std::string& text, const Table& table, const std::vector<Kind>& kinds) {
  std::vector<std::string> found;
  // A regular expression costs more than all else: it is asked where a word is that it needs.
  const auto look = [&](const std::string& word, const std::string& pattern) {
    std::smatch match;
    if (text.find(word) != std::string::npos && std::regex_search(text, match, std::regex(pattern)) &&
        !table.words.contains(match[0]))
      found.push_back(match[0]);
  };
  if (!table.question.empty()) look("Spec>", table.question);
  for (const Kind& kind : kinds) {
    look(kind.spec, "\\b" + kind.spec + "\\b");
    look(kind.name + "\"", (table.words.contains(kind.name) ? "[!=]= *\"" : "\"") + kind.name + "\"");
    look(kind.files, kind.files);
    if (table.classes) look(stem_of(kind), "\\b" + stem_of(kind) + "(?!Spec\\b)[A-Z]\\w*");
  }
  return found;
}

class Kinds : public ::testing::TestWithParam<Table> {};

TEST_P(Kinds, NoSourceElsewhereNamesOne) {
  const Table& table = GetParam();
  const std::regex homes(table.homes);
  const std::vector<Kind> all = kinds_in(table);
  ASSERT_GE(all.size(), table.least);
  int files = 0;
  for (const char* top :
       {"common", "haptic_node", "deform_node", "render_node", "web_node", "ros_bridge", "tools", "idl", "python"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(PALPATE_SOURCE) / top)) {
      const std::string extension = entry.path().extension(), file = fs::relative(entry.path(), PALPATE_SOURCE);
      if (extension != ".cpp" && extension != ".hpp") continue;
      if (std::regex_match(file, homes) || table.permitted.contains(fs::path(file).parent_path())) continue;
      ++files;
      std::vector<Kind> others = all;
      std::erase_if(others, [&](const Kind& kind) { return file.starts_with(kind.files); });
      for (const std::string& name : names_in(text_of(entry.path()), table, others))
        ADD_FAILURE() << file << " names " << name;
    }
  EXPECT_GT(files, 250);
}

INSTANTIATE_TEST_SUITE_P(Of, Kinds, ::testing::ValuesIn(kTables), [](const auto& table) {
  return std::regex_replace(table.param.file, std::regex("\\W"), "_");
});

TEST(NameOfAKind, IsFoundInCodeAndInText) {
  const std::vector<Kind> kinds{{"common/models/foam/", "soft_foam", "FoamSpec"}};
  const auto found = [&](const std::string& text, const Table& table = kTables[0]) {
    return names_in(text, table, kinds).size();
  };
  EXPECT_EQ(found("std::visit([](const auto& spec) { return owner(spec); }, body);"), 0u);
  EXPECT_EQ(found("if (as<SolidSpec>(body)) return;"), 1u);
  EXPECT_EQ(found("void check(const FoamSpec& body);"), 1u);
  EXPECT_EQ(found("std::unique_ptr<FoamPart> foam_;"), 1u);
  EXPECT_EQ(found("if (kind_of(body) == \"soft_foam\") return;"), 1u);
  EXPECT_EQ(found("#include \"common/models/foam/part.hpp\""), 1u);
  const Table spoken{.file = {}, .least = 1, .homes = {}, .permitted = {}, .words = {"soft_foam"}};
  EXPECT_EQ(found("add_option(\"soft_foam\", file);", spoken), 0u);
  EXPECT_EQ(found("if (kind_of(body) == \"soft_foam\") return;", spoken), 1u);
}

}  // namespace
}  // namespace palpate
