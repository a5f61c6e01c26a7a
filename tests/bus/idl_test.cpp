#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "common/bus/codec.hpp"
#include "common/bus/log_format.hpp"

/// The messages that were generated are those of idl/palpate.idl, which is read here once more and otherwise.
namespace palpate {
namespace {

struct IdlField {
  std::string name, type, comment;
  bool key;
};
using IdlStructs = std::map<std::string, std::vector<IdlField>>;

/// The encoding's name of an IDL type, "u32", "f64[3]", "NodalForce[]".
std::string encoded_type(std::string type, const std::string& extent) {
  static const std::map<std::string, std::string> names{{"unsigned long", "u32"}, {"unsigned long long", "u64"},
                                                        {"long long", "i64"},     {"double", "f64"},
                                                        {"float", "f32"},         {"octet", "u8"}};
  std::smatch match;
  const bool sequence = std::regex_match(type, match, std::regex(R"(sequence<(.*), \d+>)"));
  if (sequence) type = match[1];
  if (std::regex_match(type, std::regex(R"(string(<\d+>)?)"))) return "string";
  const auto known = names.find(type);
  const std::string element = known != names.end() ? known->second : type;
  return element + (sequence ? "[]" : extent);
}

IdlStructs read_idl() {
  std::ifstream in(std::string(PALPATE_SOURCE_DIR) + "/idl/palpate.idl");
  const std::regex begin(R"(@final struct (\w+) \{)");
  const std::regex field(R"(\s*(@key )?([\w ]+|\w+<.*>) (\w+)(\[\d+\])?;\s*// (.*))");
  IdlStructs structs;
  std::string line, current;
  std::smatch match;
  while (std::getline(in, line)) {
    if (std::regex_match(line, match, begin)) {
      current = match[1];
      structs[current];
    } else if (line == "};") {
      current.clear();
    } else if (!current.empty()) {
      if (line.find_first_not_of(' ') == line.find("// ")) continue;  // goes on with the comment above
      if (!std::regex_match(line, match, field)) {
        ADD_FAILURE() << "a field of " << current << " without a comment: " << line;
        continue;
      }
      structs[current].push_back({match[3], encoded_type(match[2], match[4]), match[5], match[1].matched});
    }
  }
  return structs;
}

TEST(Idl, HasTheFieldsOfTheMessagesInTheSameOrderAndOfTheSameTypes) {
  const IdlStructs idl = read_idl();
  std::string schema;
  for (const auto& [name, idl_fields] : idl) {
    std::string line = name;
    for (const IdlField& field : idl_fields)
      line.append(&field == &idl_fields.front() ? ": " : ", ").append(field.name).append(" ").append(field.type);
    EXPECT_NE(schema_text().find(line + "\n"), std::string::npos) << line;
  }
  std::istringstream lines(schema_text());
  std::string line;
  std::size_t messages = 0;
  while (std::getline(lines, line)) messages += line.find(':') != std::string::npos;
  EXPECT_EQ(messages, idl.size());
}

TEST(Idl, SaysUnitFrameAndMeaningOfEveryField) {
  const std::regex comment(R"(\[[^\]]+\] \[[^\]]+\] \S.*)");
  for (const auto& [name, idl_fields] : read_idl())
    for (const IdlField& field : idl_fields)
      EXPECT_TRUE(std::regex_match(field.comment, comment)) << name << "." << field.name << ": " << field.comment;
}

TEST(Idl, KeysAreTheFirstFieldsThatNameAToolABodyOrANode) {
  for (const auto& [name, idl_fields] : read_idl()) {
    bool leading = true;
    for (std::size_t i = 0; i < idl_fields.size(); ++i) {
      const std::string& field = idl_fields[i].name;
      const bool expected = leading && (field == "tool" || field == "body" || field == "node") &&
                            name != "NodalForce" && name != "HeldContact" && name != "LocalContact" &&
                            name != "LocalNode" && name != "ConsumedStep" && name != "ShellForce" &&
                            name != "CreepLoad";
      EXPECT_EQ(idl_fields[i].key, expected) << name << "." << field;
      leading = expected;
    }
  }
}

}  // namespace
}  // namespace palpate
