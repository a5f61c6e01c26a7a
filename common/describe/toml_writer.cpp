#include "common/describe/toml_writer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/describe/value_text.hpp"

namespace palpate {

std::string TomlWriter::text_of(const Table& table) {
  std::string text;
  for (const auto& [key, value] : table.lines) text += fmt::format("{} = {}\n", key, value);
  return text;
}

std::string TomlWriter::text() const {
  return text_of(tables_.front()) + tables_.front().below;
}

void TomlWriter::line(const Key& key, std::string value) {
  if (takes(key)) tables_.back().lines.emplace_back(key.name, std::move(value));
}

void TomlWriter::number(const Key& key, double& value, const Range&) {
  line(key, value_text::number(value));
}

void TomlWriter::numbers(const Key& key, std::vector<double>& value, const Range&) {
  std::vector<std::string> entries;
  for (const double x : value) entries.push_back(value_text::number(x));
  if (!entries.empty()) line(key, value_text::list(entries));
}

void TomlWriter::integer(const Key& key, int& value, int, int) {
  line(key, std::to_string(value));
}

void TomlWriter::flag(const Key& key, bool& value) {
  line(key, value ? "true" : "false");
}

void TomlWriter::text(const Key& key, std::string& value) {
  if (!value.empty()) line(key, value_text::text(value));
}

void TomlWriter::texts(const Key& key, std::vector<std::string>& value) {
  std::vector<std::string> entries;
  for (const std::string& entry : value) entries.push_back(value_text::text(entry));
  if (!entries.empty()) line(key, value_text::list(entries));
}

void TomlWriter::choice(const Key& key, std::string& value, std::span<const std::string_view>) {
  line(key, value_text::text(value));
}

void TomlWriter::vector(const Key& key, Eigen::Vector3d& value) {
  line(key, value_text::vector(value));
}

void TomlWriter::colour(const Key& key, std::array<double, 3>& value) {
  line(key, value_text::vector(Eigen::Vector3d(value.data())));
}

void TomlWriter::box(const Key& key, std::optional<Box>& value) {
  if (value) line(key, value_text::box(*value));
}

void TomlWriter::axes(const Key& key, std::array<bool, 3>& value) {
  line(key, value_text::axes(value));
}

void TomlWriter::indices(const Key& key, std::vector<int>& value) {
  if (!value.empty()) line(key, value_text::indices(value));
}

void TomlWriter::path(const Key& key, std::filesystem::path& value) {
  if (!value.empty()) line(key, value_text::text(value.string()));
}

void TomlWriter::only_with(std::string_view key, std::string_view other) {
  auto& lines = tables_.back().lines;
  const auto named = [](std::string_view name) { return [=](const auto& line) { return line.first == name; }; };
  if (std::ranges::none_of(lines, named(other))) std::erase_if(lines, named(key));
}

bool TomlWriter::enter(const Key& key, bool present, bool) {
  if (!present) return false;
  tables_.push_back({.path = tables_.back().path.below(key.name, false), .taken = takes_table(key)});
  return true;
}

void TomlWriter::enter_item(const Key& key, std::size_t) {
  tables_.push_back({.path = tables_.back().path.below(key.name, true), .taken = takes_table(key)});
}

void TomlWriter::leave() {
  const Table table = std::move(tables_.back());
  tables_.pop_back();
  const bool empty = table.lines.empty() && table.below.empty();
  if (!table.taken || (empty && !takes_empty_tables())) return;
  tables_.back().below += fmt::format("\n{}\n{}{}", table.path.name(), text_of(table), table.below);
}

std::size_t TomlWriter::alternative(const Key& key, std::span<const std::string_view> kinds, std::size_t current) {
  line(key, value_text::text(kinds[current]));
  return current;
}

}  // namespace palpate
