#include "common/scene/table_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace palpate {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool contains(const Range& range, double x) {
  return (range.low_allowed ? x >= range.low : x > range.low) &&
         (range.high_allowed ? x <= range.high : x < range.high);
}

std::string describe(const Range& range) {
  const std::string low = fmt::format("{} {}", range.low_allowed ? "at least" : "greater than", range.low);
  if (range.high == kInfinity) return low;
  return fmt::format("{} and {} {}", low, range.high_allowed ? "at most" : "less than", range.high);
}

std::string_view kind(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    case toml::node_type::date:
      return "a date";
    case toml::node_type::time:
      return "a time";
    case toml::node_type::date_time:
      return "a date and time";
    default:
      return "nothing";
  }
}

}  // namespace

Range above(double low) {
  return {low, kInfinity, false, true};
}
Range at_least(double low) {
  return {low, kInfinity, true, true};
}
Range within(double low, double high) {
  return {low, high, true, true};
}
Range strictly_within(double low, double high) {
  return {low, high, false, false};
}

TableReader::TableReader(const toml::table& table, std::string_view name, const std::filesystem::path& file)
    : table_(&table), schema_(&table_schema(name)), file_(&file) {
  for (const auto& [key, node] : table) {
    if (std::ranges::find(schema_->keys, key.str()) != schema_->keys.end()) continue;
    const std::string_view near = nearest(key.str(), schema_->keys);
    const std::string hint = near.empty() ? "" : fmt::format("; did you mean '{}'?", near);
    fail(key.source(), fmt::format("unknown key '{}' in {}{}", key.str(), schema_->name, hint));
  }
}

bool TableReader::has(std::string_view key) const {
  return find(key, Need::optional) != nullptr;
}

const toml::node* TableReader::find(std::string_view key, Need need) const {
  if (std::ranges::find(schema_->keys, key) == schema_->keys.end())
    throw std::logic_error(fmt::format("key '{}' is not in the schema of {}", key, schema_->name));
  const toml::node* node = table_->get(key);
  if (!node && need == Need::required) fail(fmt::format("{} needs the key '{}'", schema_->name, key));
  return node;
}

void TableReader::fail(const toml::source_region& where, std::string_view sentence) const {
  throw std::runtime_error(fmt::format("{}:{}:{}: {}", file_->string(), std::max(1u, where.begin.line),
                                       std::max(1u, where.begin.column), sentence));
}

void TableReader::fail(std::string_view sentence) const {
  fail(table_->source(), sentence);
}

void TableReader::fail_at(std::string_view key, std::string_view sentence) const {
  const toml::node* node = find(key, Need::optional);
  fail(node ? node->source() : table_->source(), sentence);
}

double TableReader::finite_number(const toml::node& node, std::string_view what) const {
  if (!node.is_number()) fail(node.source(), fmt::format("{} must be a number, not {}", what, kind(node)));
  const double x = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  if (!std::isfinite(x)) fail(node.source(), fmt::format("{} must be finite", what));
  return x;
}

Eigen::Vector3d TableReader::three_numbers(const toml::node& node, std::string_view what) const {
  const toml::array* list = node.as_array();
  if (!list || list->size() != 3) fail(node.source(), fmt::format("{} must be a list of three numbers", what));
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = finite_number((*list)[i], what);
  return v;
}

std::string TableReader::plain_text(const toml::node& node, std::string_view what) const {
  if (!node.is_string()) fail(node.source(), fmt::format("{} must be a string, not {}", what, kind(node)));
  const std::string& value = node.as_string()->get();
  if (value.empty()) fail(node.source(), fmt::format("{} must not be empty", what));
  if (value.find('\0') != value.npos) fail(node.source(), fmt::format("{} must not hold a zero character", what));
  return value;
}

void TableReader::number(std::string_view key, double& value, const Range& range, Need need) const {
  const toml::node* node = find(key, need);
  if (!node) return;
  const double x = finite_number(*node, key);
  if (!contains(range, x)) fail(node->source(), fmt::format("{} must be {}, and is {}", key, describe(range), x));
  value = x;
}

void TableReader::integer(std::string_view key, int& value, int low, int high, Need need) const {
  const toml::node* node = find(key, need);
  if (!node) return;
  if (!node->is_integer()) fail(node->source(), fmt::format("{} must be an integer, not {}", key, kind(*node)));
  const std::int64_t x = node->as_integer()->get();
  if (x < low || x > high)
    fail(node->source(), fmt::format("{} must be at least {} and at most {}, and is {}", key, low, high, x));
  value = static_cast<int>(x);
}

void TableReader::flag(std::string_view key, bool& value) const {
  const toml::node* node = find(key, Need::optional);
  if (!node) return;
  if (!node->is_boolean()) fail(node->source(), fmt::format("{} must be true or false, not {}", key, kind(*node)));
  value = node->as_boolean()->get();
}

void TableReader::text(std::string_view key, std::string& value, Need need) const {
  if (const toml::node* node = find(key, need)) value = plain_text(*node, key);
}

void TableReader::choice(std::string_view key, std::string& value, const std::vector<std::string_view>& allowed) const {
  const toml::node* node = find(key, Need::optional);
  if (!node) return;
  const std::string word = plain_text(*node, key);
  std::string known;
  for (std::string_view one : allowed) known.append(known.empty() ? "" : ", ").append(one);
  if (std::ranges::find(allowed, word) == allowed.end())
    fail(node->source(), fmt::format("{} '{}' is unknown; known: {}", key, word, known));
  value = word;
}

void TableReader::texts(std::string_view key, std::vector<std::string>& value) const {
  const toml::node* node = find(key, Need::optional);
  if (!node) return;
  if (!node->is_array()) fail(node->source(), fmt::format("{} must be a list of strings, not {}", key, kind(*node)));
  value.clear();
  for (const toml::node& entry : *node->as_array()) value.push_back(plain_text(entry, key));
}

void TableReader::group(std::string_view key, std::string& value) const {
  const toml::node* node = find(key, Need::optional);
  if (!node) return;
  value = node->is_integer() ? std::to_string(node->as_integer()->get()) : plain_text(*node, key);
}

void TableReader::vector(std::string_view key, Eigen::Vector3d& value, Need need) const {
  if (const toml::node* node = find(key, need)) value = three_numbers(*node, key);
}

std::array<Eigen::Vector3d, 2> TableReader::vector_pair(std::string_view key) const {
  const toml::node& node = *find(key, Need::required);
  const toml::array* list = node.as_array();
  if (!list || list->size() != 2) fail(node.source(), fmt::format("{} must be [[x, y, z], [x, y, z]]", key));
  return {three_numbers((*list)[0], key), three_numbers((*list)[1], key)};
}

void TableReader::indices(std::string_view key, std::vector<int>& value) const {
  const toml::node* node = find(key, Need::optional);
  if (!node) return;
  const toml::array* list = node->as_array();
  if (!list) fail(node->source(), fmt::format("{} must be a list of integers, not {}", key, kind(*node)));
  if (list->empty()) fail(node->source(), fmt::format("{} must not be empty", key));
  value.clear();
  std::set<std::int64_t> seen;
  for (const toml::node& entry : *list) {
    if (!entry.is_integer()) fail(entry.source(), fmt::format("{} must hold integers, not {}", key, kind(entry)));
    const std::int64_t x = entry.as_integer()->get();
    if (x < 0 || x > std::numeric_limits<int>::max())
      fail(entry.source(), fmt::format("{} counts from 0, and {} is out of range", key, x));
    if (!seen.insert(x).second) fail(entry.source(), fmt::format("{} holds {} twice", key, x));
    value.push_back(static_cast<int>(x));
  }
}

void TableReader::path(std::string_view key, std::filesystem::path& value, Need need) const {
  const toml::node* node = find(key, need);
  if (!node) return;
  value = (file_->parent_path() / plain_text(*node, key)).lexically_normal();
  value = std::filesystem::absolute(value).lexically_normal();
}

void TableReader::existing_file(std::string_view key, std::filesystem::path& value, Need need) const {
  path(key, value, need);
  if (!has(key)) return;
  std::error_code error;
  if (!std::filesystem::is_regular_file(value, error))
    fail_at(key, fmt::format("{} '{}' is not a file that can be read", key, value.string()));
}

std::optional<TableReader> TableReader::table(std::string_view key, std::string_view name) const {
  const toml::node* node = find(key, Need::optional);
  if (!node) return {};
  if (!node->is_table())
    fail(node->source(), fmt::format("{} must be a table, not {}: write {}", key, kind(*node), name));
  return TableReader(*node->as_table(), name, *file_);
}

std::vector<TableReader> TableReader::tables(std::string_view key, std::string_view name) const {
  const toml::node* node = find(key, Need::optional);
  if (!node) return {};
  const auto wrong = [&](const toml::node& at) {
    fail(at.source(), fmt::format("{} must be a list of tables, not {}: write {}", key, kind(at), name));
  };
  if (!node->is_array()) wrong(*node);
  std::vector<TableReader> readers;
  for (const toml::node& entry : *node->as_array()) {
    if (!entry.is_table()) wrong(entry);
    readers.emplace_back(*entry.as_table(), name, *file_);
  }
  return readers;
}

}  // namespace palpate
