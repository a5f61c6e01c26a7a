#include "tools/shared/check_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/describe/printable.hpp"
#include "tools/shared/human_bytes.hpp"

namespace palpate {
namespace {

std::string_view without_indent(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  return line;
}

/// Names and files in it are the scene's.
void print(std::string_view line) {
  fmt::print("{}\n", printable(line));
}

}  // namespace

nlohmann::ordered_json& CheckOutput::here() {
  return list_.empty() ? all_ : all_[list_].back();
}

void CheckOutput::fact(std::string_view key, const std::string& value, const std::string& line) {
  if (json_)
    all_[key] = value;
  else
    print(line);
}

void CheckOutput::about(std::string_view list, const std::string& name) {
  list_ = list;
  if (!list_.empty()) all_[list_].emplace_back(nlohmann::ordered_json{{"name", name}});
}

void CheckOutput::say(std::string_view line) {
  if (json_)
    here()["said"].emplace_back(without_indent(line));
  else
    print(line);
}

void CheckOutput::memory(std::span<const MemoryPart> parts) {
  for (const MemoryPart& part : parts)
    if (json_)
      here()["memory"].emplace_back(
          nlohmann::ordered_json{{"owner", part.owner}, {"what", part.what}, {"bytes", part.bytes}});
    else
      fmt::print("  {:>10}  {:<20}  {}\n", human_bytes(part.bytes), part.owner, part.what);
}

void CheckOutput::nodes(const std::vector<std::string>& names) {
  if (json_)
    all_["nodes"] = names;
  else
    fmt::print("nodes: {}\n", fmt::join(names, ", "));
}

void CheckOutput::left_out(std::string_view line) {
  if (json_)
    all_["left_out"].emplace_back(line);
  else
    fmt::print("{}  {}\n", std::exchange(headed_, true) ? "" : "left out:\n", printable(line));
}

void CheckOutput::warn(const std::string& sentence) {
  if (json_)
    all_["warnings"].emplace_back(sentence);
  else
    print("warning: " + sentence);
}

nlohmann::ordered_json CheckOutput::json() const {
  nlohmann::ordered_json all = all_;
  for (const char* list : {"left_out", "warnings"}) all.emplace(list, nlohmann::ordered_json::array());
  return all;
}

}  // namespace palpate
