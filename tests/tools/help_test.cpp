// What every command says of itself.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>

#include "tests/tools/program_result.hpp"

namespace palpate {
namespace {

using testing::program;
using testing::run_program;

struct HelpOf {
  std::string command, text;
};

/// Of every command that `palpate help` names and whose program is built.
std::vector<HelpOf> all_help() {
  const std::string all = run_program(program("palpate") + " help").out;
  const std::regex row(R"(\n  ([a-z]+) {2,})");
  std::vector<HelpOf> found;
  for (std::sregex_iterator at(all.begin(), all.end(), row), end; at != end; ++at) {
    const auto help = run_program(program("palpate") + " help " + (*at)[1].str());
    if (help.err.find("is in a program of its own that is not here") != std::string::npos) continue;
    EXPECT_EQ(help.status, 0) << (*at)[1] << ": " << help.err;
    found.push_back({(*at)[1], help.out});
  }
  return found;
}

std::set<std::string> matches(const std::string& text, const char* pattern) {
  const std::regex sought(pattern);
  std::set<std::string> all;
  for (std::sregex_iterator at(text.begin(), text.end(), sought), end; at != end; ++at) all.insert((*at)[1]);
  return all;
}

TEST(ToolsHelp, EveryCommandHasExamplesOfOptionsThatItHas) {
  const std::vector<HelpOf> all = all_help();
  EXPECT_GE(all.size(), 19u);
  for (const auto& [command, text] : all) {
    const std::size_t at = text.find("\nExamples:\n  palpate " + command);
    ASSERT_NE(at, std::string::npos) << text;
    const std::set<std::string> options = matches(text.substr(0, at), R"([ ,](--?[a-z][a-z-]*))");
    for (const std::string& used : matches(text.substr(at), R"([ "](--?[a-z][a-z-]*))"))
      EXPECT_TRUE(options.contains(used)) << command << ": its example has " << used;
  }
}

TEST(ToolsHelp, EveryNodeAndDriverHasExamplesOfOptionsThatItHas) {
  for (const char* node :
       {"haptic_node", "deform_node", "render_node", "web_node", "ros_bridge", "palpate_spacemouse"}) {
    if (!std::filesystem::exists(program(node))) continue;
    const std::string text = run_program(program(node) + " --help").out;
    const std::size_t at = text.find(std::string("\nExamples:\n  ") + node);
    ASSERT_NE(at, std::string::npos) << text;
    const std::set<std::string> options = matches(text.substr(0, at), R"([ ,](--?[a-z][a-z-]*))");
    for (const std::string& used : matches(text.substr(at), R"([ "](--?[a-z][a-z-]*))"))
      EXPECT_TRUE(options.contains(used)) << node << ": its example has " << used;
  }
}

TEST(ToolsHelp, WhatIsToldByItsPlaceIsInCapitalsAndTheFolderOrFileThatIsMadeIsTheOutput) {
  for (const auto& [command, text] : all_help()) {
    const auto usage = matches(text, R"((Usage: [^\n]*))");
    ASSERT_EQ(usage.size(), 1u) << text;
    EXPECT_FALSE(std::regex_search(*usage.begin(), std::regex(command + R"([^\n]* [a-z]+( |$))"))) << *usage.begin();
    EXPECT_EQ(text.find("--out "), std::string::npos) << text;
  }
}

TEST(ToolsHelp, AnOptionThatIsNoneIsNamedBeforeWhatIsMissing) {
  for (const auto& [command, text] : all_help()) {
    const auto result = run_program(program("palpate") + " " + command + " --no-such-option");
    EXPECT_NE(result.status, 0) << command;
    EXPECT_NE(result.err.find("--no-such-option"), std::string::npos) << command << ": " << result.err;
  }
}

TEST(ToolsHelp, EveryMistakeHasTheSameStatus) {
  const std::string scene = std::string(PALPATE_SOURCE) + "/scenes/plate.toml";
  for (const std::string& words :
       {std::string("no-such-command"), std::string("check"), std::string("check no_such_file.toml"),
        "check " + scene + " --no-such-option", "check " + scene + " one more", "drive " + scene + " --seconds ten",
        "drive " + scene + " --quiet --verbose", "study " + scene + " -o never --budget 50"}) {
    const auto result = run_program(program("palpate") + " " + words);
    EXPECT_EQ(result.status, 1) << words;
    EXPECT_FALSE(result.err.empty()) << words;
  }
}

// Help writes three numbers with commas.
TEST(ToolsHelp, ThreeNumbersAreTakenBetweenSpacesOrCommas) {
  const testing::OwnFolder folder("help");
  const std::string with_spaces = folder / "spaces.msh", with_commas = folder / "commas.msh";
  const std::string block = program("palpate_generate") + " block --cells 2,3,4 ";
  ASSERT_EQ(run_program(block + "--min -0.03 -0.03 -0.02 --max 0.03 0.03 0 -o " + with_spaces).status, 0);
  const auto result = run_program(block + "--min=-0.03,-0.03,-0.02 --max 0.03,0.03,0 -o " + with_commas);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(testing::text_of(with_spaces), testing::text_of(with_commas));
}

TEST(ToolsHelp, BashOffersCommandsAndEachOfTheirOptionsOnce) {
  const auto offered = [](const std::string& words) {
    const std::string script = ". " PALPATE_SOURCE "/scripts/completion/palpate; COMP_WORDS=(" + program("palpate") +
                               " " + words + "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _palpate; echo ${COMPREPLY[*]}";
    return run_program("bash -c \"" + std::regex_replace(script, std::regex(R"([$"])"), R"(\$&)") + "\"").out;
  };
  EXPECT_EQ(offered("--"), "--help --version\n");
  EXPECT_EQ(offered("exp"), "export\n");
  EXPECT_EQ(offered("export --"), "--help --topic --csv --jsonl --mcap --output --force\n");
  EXPECT_EQ(offered("drive scene.toml --co"), "--course\n");
  EXPECT_EQ(offered("record --keep e"), "everything enough\n");
  EXPECT_EQ(offered("solve scene.toml --method t"), "tensors\n");
  EXPECT_EQ(offered("export log"), "\n") << "files";
}

TEST(ToolsHelp, HelpThatCannotBeWrittenIsTold) {
  EXPECT_EQ(run_program("{ " + program("palpate") + " --help > /dev/full; }").status, 1);
}

}  // namespace
}  // namespace palpate
