#include "common/scene/change_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <vector>

namespace palpate {
namespace {

[[noreturn]] void fail(const SceneChange& change, std::string_view sentence) {
  throw std::runtime_error(fmt::format("--set {}: {}", change.argument(), sentence));
}

/// The value as TOML, with the change as its place.
toml::table parse_value(const SceneChange& change, std::string_view text) {
  return toml::parse(fmt::format("value = {}", text), "--set " + change.argument());
}

bool is_word(std::string_view text) {
  constexpr std::string_view kSigns = "_-./";
  return !text.empty() && std::ranges::all_of(text, [&](unsigned char c) {
    return c < 128 && (std::isalnum(c) || kSigns.find(static_cast<char>(c)) != kSigns.npos);
  });
}

toml::table value_of(const SceneChange& change) {
  toml::table parsed;
  try {
    parsed = parse_value(change, change.value);
  } catch (const toml::parse_error& error) {
    if (!is_word(change.value)) fail(change, error.description());
    parsed = parse_value(change, "\"" + change.value + "\"");
  }
  if (parsed.size() != 1) fail(change, "give one value");
  return parsed;
}

std::vector<std::string> steps_of(const SceneChange& change) {
  std::vector<std::string> steps(1);
  for (const char c : change.key) {
    if (c == '.')
      steps.emplace_back();
    else
      steps.back() += c;
  }
  return steps;
}

toml::key key_of(const SceneChange& change, const std::string& name) {
  static const auto place = [](const SceneChange& of) { return parse_value(of, "0").get("value")->source(); };
  return toml::key(name, place(change));
}

std::string name_in(const toml::node& entry) {
  return entry.as_table() ? (*entry.as_table())["name"].value_or(std::string()) : std::string();
}

/// The entry of a list that `step` names, or null.
toml::node* entry_of(toml::array& list, const std::string& step) {
  for (toml::node& entry : list)
    if (name_in(entry) == step) return &entry;
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), number);
  return error == std::errc() && end == step.data() + step.size() ? list.get(number) : nullptr;
}

/// Walks down a change's key, table by table.
class Walk {
 public:
  Walk(toml::table& scene, const SceneChange& change) : change_(change), steps_(steps_of(change)), table_(&scene) {}

  void put() {
    while (at_ + 1 < steps_.size()) step_down();
    toml::table value = value_of(change_);
    value.get("value")->visit(
        [&](auto& node) { table_->insert_or_assign(key_of(change_, steps_.back()), std::move(node)); });
  }

 private:
  void step_down() {
    const std::string& name = steps_[at_++];
    if (!table_->contains(name)) {
      toml::table empty = parse_value(change_, "{}");
      table_->insert_or_assign(key_of(change_, name), std::move(*empty.get_as<toml::table>("value")));
    }
    toml::node* node = table_->get(name);
    if (toml::array* list = node->as_array()) node = &choose(*list, name);
    table_ = node->as_table();
    if (!table_) fail(change_, fmt::format("'{}' is a value, not a table with keys", name));
  }

  toml::node& choose(toml::array& list, const std::string& name) {
    if (at_ + 1 < steps_.size())
      if (toml::node* entry = entry_of(list, steps_[at_])) {
        ++at_;
        return *entry;
      }
    if (list.size() == 1) return list[0];
    std::string names;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string own = name_in(list[i]);
      names += fmt::format("{}{}", i == 0 ? "" : ", ", own.empty() ? std::to_string(i) : own);
    }
    fail(change_, fmt::format("the scene has {} entries of '{}': name one of {} behind it", list.size(), name, names));
  }

  const SceneChange& change_;
  std::vector<std::string> steps_;
  std::size_t at_ = 0;
  toml::table* table_;
};

}  // namespace

SceneChange parse_change(std::string_view argument) {
  constexpr std::size_t kLongest = 4096;
  const std::size_t equals = argument.find('=');
  if (argument.size() > kLongest) throw std::runtime_error("--set: longer than 4096 characters");
  if (equals == argument.npos || equals == 0 || equals + 1 == argument.size())
    throw std::runtime_error(fmt::format("--set {}: give KEY=VALUE, such as body.young=8000", argument));
  return {std::string(argument.substr(0, equals)), std::string(argument.substr(equals + 1))};
}

std::vector<SceneChange> parse_changes(std::span<const std::string> arguments) {
  std::vector<SceneChange> changes;
  for (const std::string& argument : arguments) changes.push_back(parse_change(argument));
  return changes;
}

void change_table(toml::table& scene, const SceneChange& change) {
  Walk(scene, change).put();
}

}  // namespace palpate
