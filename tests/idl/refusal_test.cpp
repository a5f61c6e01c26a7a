#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/idl/text_of.hpp"

/// An IDL whose annotations do not have the form is refused with a sentence that names the line.
namespace palpate {
namespace {

namespace fs = std::filesystem;

using testing::text_of;

/// What the generator says of IDL files with these texts, in one run for all of them; empty: it takes them.
std::vector<std::string> said_of(const std::vector<std::string>& texts) {
  const fs::path folder = fs::temp_directory_path() / ("palpate_toy_" + std::to_string(::getpid()));
  std::string command = PALPATE_REFUSALS;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const fs::path one = folder / std::to_string(i);
    fs::create_directories(one);
    std::ofstream(one / "bad.idl") << texts[i];
    command += " " + one.string();
  }
  EXPECT_EQ(std::system(command.c_str()), 0) << "it ended with an exception";
  std::vector<std::string> said;
  for (std::size_t i = 0; i < texts.size(); ++i) said.push_back(text_of(folder / std::to_string(i) / "said"));
  fs::remove_all(folder);
  return said;
}

/// The toy with one place changed, and what is said of it: the number of the line and what stands in the sentence.
struct Change {
  const char *from, *to, *said;
};

const Change kChanges[] = {
    {"[-] [-] in the pod", "in the pod",
     "bad.idl:18: a field of Pea is 'type name;  // [unit] [frame] [limits] meaning'"},
    {"[-] [-] in the pod", "[-] [-] [0..1]", "bad.idl:18: a field of Pea is"},
    {"unsigned long place;  ", "unsigned short place; ", "bad.idl:18: Pea.place: 'unsigned short' is no type"},
    {"[m] [plate] where it lies", "[-] [plate] where it lies", "bad.idl:19: Pea.centre has a unit"},
    {"unsigned long right;", "unsigned long left;", "bad.idl:25: Prongs.left is there twice"},
    {"struct Prongs", "struct Pea", "bad.idl:23: Pea is there twice"},
    {"// A fork's prongs.\n", "", "bad.idl:22: Prongs has no comment above it"},
    {"sequence<Pea, 5>", "sequence<Pea>", "bad.idl:60: Dish.peas: 'sequence<Pea>' is no type"},
    {"sequence<Pea, 5>", "sequence<Nut, 5>", "bad.idl:60: Dish.peas: 'sequence<Nut, 5>' is no type"},
    {"unsigned long place;  ", "string<9> place;",
     "bad.idl:60: Dish.peas: a struct in a sequence has numbers and arrays"},
    {"  long long publish_ns;", "  @key long long publish_ns;", "bad.idl:46: Dish.publish_ns: keys are"},
    {"[..max_plates]", "[..max_cups]", "bad.idl:44: Dish.table: the limits '..max_cups' name neither a number"},
    {"[above 0]", "[positive]", "bad.idl:47: Dish.weight: the limits 'positive' are none that there are"},
    {"[above 0]", "[..]", "bad.idl:47: Dish.weight: the limits '..' leave everything open"},
    {"[-1..weight]", "[-1..up]", "bad.idl:48: Dish.sauce: the limits '-1..up' name an array"},
    {"[unit vector]", "[0..1]", "bad.idl:51: Dish.up: the limits '0..1' are for a number or string or sequence"},
    {"[unit vector] of the plate", "of the plate", ""},
    {"[cold..late]", "[unit vector]", "bad.idl:53: Dish.complaint: the limits 'unit vector' are for a double[3]"},
    {"[multiple of 3]", "[above 3]", "bad.idl:58: Dish.rim: the limits 'above 3' are for a number"},
    {"[as many as rim]", "[as many as seq]", "bad.idl:59: Dish.tint: the limits 'as many as seq' name no sequence"},
    {"[indices of peas]", "[indices of dish]", "bad.idl:61: Dish.forks: the limits 'indices of dish' name no sequence"},
    {"[-] [-] on the plate", "[-] [-] [indices of rim] x",
     "bad.idl:60: Dish.peas: the limits 'indices of rim' are for a"},
    {"//   rate     when it is ready\n", "", "bad.idl:31: the topic dish does not say its rate"},
    {"//   rate     when it is ready", "//   speed    high",
     "bad.idl:33: in a topic stand delivery, rate, writers and"},
    {"writers  cook, waiter", "writers  cook, cat", "bad.idl:31: the topic dish: its writers name 'cat'"},
    {"readers  all but cook", "readers  all but cat", "bad.idl:31: the topic dish: its readers name 'cat'"},
    {"reliable, keeps max_plates", "reliable", "bad.idl:31: the topic dish: delivery is 'reliable, keeps N'"},
    {"reliable, keeps max_plates", "reliable, keeps 0", "bad.idl:31: the topic dish: delivery is 'reliable, keeps N'"},
    {"keeps all, late joiners get all", "keeps all", "bad.idl:66: the topic bill: delivery is"},
    {"topic palpate/leftovers:", "topic palpate/dish:", "bad.idl:37: the topic dish is there twice"},
    {"@final struct Bill", "\n@final struct Bill", "bad.idl:71: a topic stands in the comment right above its struct"},
    {"@final struct Bill", "struct Bill", "bad.idl:71: neither module, const, enum, @final struct nor comment"},
    {"  late\n", "  3 late\n", "bad.idl:13: an enumerator of Complaint is"},
    {"// roles: cook, waiter, guest", "", "bad.idl:1: there is no line"},
};

TEST(ToyIdl, IsTakenAsItIsAndRefusedWithTheLineWhereAnAnnotationIsMalformed) {
  const std::string toy = text_of(PALPATE_TOY_IDL);
  std::vector<std::string> texts{toy};
  for (const auto& [from, to, said] : kChanges) {
    const std::size_t at = toy.find(from);
    ASSERT_NE(at, toy.npos) << from;
    texts.push_back(std::string(toy).replace(at, std::string(from).size(), to));
  }
  const std::vector<std::string> answers = said_of(texts);
  EXPECT_EQ(answers[0], "");
  for (std::size_t i = 0; i < std::size(kChanges); ++i) {
    const auto& [from, to, said] = kChanges[i];
    const std::string& answer = answers[i + 1];
    EXPECT_EQ(answer.empty(), *said == '\0') << from << " -> " << to;
    EXPECT_EQ(answer.substr(0, std::string(said).size()), said) << from << " -> " << to;
  }
}

}  // namespace
}  // namespace palpate
