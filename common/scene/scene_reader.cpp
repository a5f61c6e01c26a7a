#include "common/scene/scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/geometry/direction.hpp"
#include "common/scene/nearest.hpp"

namespace palpate {
namespace {

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

SceneReader::SceneReader(const toml::table& table, const KeyList& known, std::filesystem::path file,
                         const MovedFiles& moved)
    : known_(known), file_(std::move(file)), moved_(moved), levels_{{&table, {}}} {
  refuse_unknown();
}

void SceneReader::fail(const toml::source_region& where, std::string_view sentence) const {
  if (where.path && *where.path != file_.string())  // not of the file, but given beside it
    throw std::runtime_error(fmt::format("{}: {}", *where.path, sentence));
  throw std::runtime_error(fmt::format("{}:{}:{}: {}", file_.string(), std::max(1u, where.begin.line),
                                       std::max(1u, where.begin.column), sentence));
}

void SceneReader::fail_at(std::string_view key, std::string_view sentence) const {
  const toml::node* node = find(key);
  fail(node ? node->source() : levels_.back().table->source(), sentence);
}

void SceneReader::refuse_unknown() const {
  const DescribedTable& table = *known_.find(levels_.back().path.path);
  std::vector<std::string_view> names;
  for (const DescribedKey& key : table.keys) names.push_back(key.name);
  for (const auto& [key, node] : *levels_.back().table) {
    if (table.find(key.str())) continue;
    const std::string_view near = nearest(key.str(), names);
    const std::string hint = near.empty() ? "" : fmt::format("; did you mean '{}'?", near);
    fail(key.source(), fmt::format("unknown key '{}' in {}{}", key.str(), levels_.back().path.name(), hint));
  }
}

bool SceneReader::Choice::strange(const std::string& path, std::string_view name) const {
  const auto has = [&](const KeyList& list) {
    const DescribedTable* table = list.find(path);
    return table && table->find(name);
  };
  return !has(own) && std::ranges::any_of(others, has);
}

/// Put there by a change to the scene, not by its file.
bool is_change(const toml::node* node) {
  return node && node->source().path && node->source().path->starts_with("--set ");
}

// Keys that belong to another alternative than the one that was chosen. Who chooses anew by a change need not know the
// file's: those are let go.
void SceneReader::refuse_strange() const {
  const Level& level = levels_.back();
  for (const auto& [key, node] : *level.table)
    for (const Choice& choice : choices_) {
      if (!choice.strange(level.path.path, key.str())) continue;
      const DescribedKey& row = *known_.find(level.path.path)->find(key.str());
      if (!row.is_table && is_change(levels_[choice.depth - 1].table->get(choice.key)) && !is_change(&node)) continue;
      const TablePath below = level.path.below(key.str(), row.type == "list of tables");
      fail(node.source(), fmt::format("{} means nothing for the {} '{}'", row.is_table ? below.name() : row.name,
                                      choice.key, choice.kind));
    }
}

void SceneReader::refuse_missing(const Key& key) const {
  const Level& level = levels_.back();
  const DescribedKey* row = known_.find(level.path.path)->find(key.name);
  if (row->is_table && !choices_.empty() && choices_.back().depth == levels_.size()) {
    const Choice& choice = choices_.back();
    fail_at(choice.key, fmt::format("the {} '{}' needs a {}: {}", choice.key, choice.kind,
                                    level.path.below(key.name, false).name(), key.meaning));
  }
  fail(level.table->source(), fmt::format("{} needs the key '{}'", level.path.name(), key.name));
}

const toml::node* SceneReader::find(const Key& key) const {
  const toml::node* node = find(key.name);
  if (!node && key.need == Need::required) refuse_missing(key);
  return node;
}

double SceneReader::finite_number(const toml::node& node, std::string_view what) const {
  if (!node.is_number()) fail(node.source(), fmt::format("{} must be a number, not {}", what, kind(node)));
  const double x = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  if (!std::isfinite(x)) fail(node.source(), fmt::format("{} must be finite", what));
  return x;
}

Eigen::Vector3d SceneReader::three_numbers(const toml::node& node, std::string_view what) const {
  const toml::array* list = node.as_array();
  if (!list || list->size() != 3) fail(node.source(), fmt::format("{} must be a list of three numbers", what));
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = finite_number((*list)[i], what);
  return v;
}

std::string SceneReader::plain_text(const toml::node& node, std::string_view what) const {
  if (!node.is_string()) fail(node.source(), fmt::format("{} must be a string, not {}", what, kind(node)));
  const std::string& value = node.as_string()->get();
  if (value.empty()) fail(node.source(), fmt::format("{} must not be empty", what));
  if (value.find('\0') != value.npos) fail(node.source(), fmt::format("{} must not hold a zero character", what));
  return value;
}

std::string_view SceneReader::one_of(const toml::node& node, std::string_view what,
                                     std::span<const std::string_view> allowed) const {
  const std::string value = plain_text(node, what);
  const auto found = std::ranges::find(allowed, value);
  if (found == allowed.end())
    fail(node.source(), fmt::format("{} '{}' is unknown; known: {}", what, value, fmt::join(allowed, ", ")));
  return *found;
}

void SceneReader::number(const Key& key, double& value, const Range& range) {
  const toml::node* node = find(key);
  if (!node) return;
  const double x = finite_number(*node, key.name);
  if (!range.contains(x)) fail(node->source(), fmt::format("{} must be {}, and is {}", key.name, range.words(), x));
  value = x;
}

const toml::array* SceneReader::find_list(const Key& key, const char* of) const {
  const toml::node* node = find(key);
  if (!node) return nullptr;
  const toml::array* list = node->as_array();
  if (!list) fail(node->source(), fmt::format("{} must be a list of {}, not {}", key.name, of, kind(*node)));
  if (list->empty()) fail(node->source(), fmt::format("{} must not be empty", key.name));
  return list;
}

void SceneReader::numbers(const Key& key, std::vector<double>& value, const Range& range) {
  const toml::array* list = find_list(key, "numbers");
  if (!list) return;
  value.clear();
  for (const toml::node& entry : *list) {
    value.push_back(finite_number(entry, key.name));
    if (!range.contains(value.back()))
      fail(entry.source(), fmt::format("{} must be {}, and one is {}", key.name, range.words(), value.back()));
  }
}

void SceneReader::integer(const Key& key, int& value, int low, int high) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_integer()) fail(node->source(), fmt::format("{} must be an integer, not {}", key.name, kind(*node)));
  const std::int64_t x = node->as_integer()->get();
  if (x < low || x > high)
    fail(node->source(), fmt::format("{} must be at least {} and at most {}, and is {}", key.name, low, high, x));
  value = static_cast<int>(x);
}

void SceneReader::flag(const Key& key, bool& value) {
  const toml::node* node = find(key);
  if (!node) return;
  if (!node->is_boolean()) fail(node->source(), fmt::format("{} must be true or false, not {}", key.name, kind(*node)));
  value = node->as_boolean()->get();
}

void SceneReader::text(const Key& key, std::string& value) {
  if (const toml::node* node = find(key)) value = plain_text(*node, key.name);
}

void SceneReader::name(const Key& key, std::string& value) {
  text(key, value);
  const auto plain = [](unsigned char c) { return c < 128 && (std::isalnum(c) || c == '_' || c == '-'); };
  require(value.size() <= 31 && std::ranges::all_of(value, plain), key.name,
          fmt::format("name '{}' must be 1 to 31 letters, digits, '_' or '-'", value));
}

void SceneReader::texts(const Key& key, std::vector<std::string>& value) {
  const toml::node* node = find(key);
  if (!node) return;
  const toml::array* list = node->as_array();
  if (!list) fail(node->source(), fmt::format("{} must be a list of strings, not {}", key.name, kind(*node)));
  value.clear();
  for (const toml::node& entry : *list) value.push_back(plain_text(entry, key.name));
}

void SceneReader::choice(const Key& key, std::string& value, std::span<const std::string_view> allowed) {
  if (const toml::node* node = find(key)) value = one_of(*node, key.name, allowed);
}

void SceneReader::vector(const Key& key, Eigen::Vector3d& value) {
  if (const toml::node* node = find(key)) value = three_numbers(*node, key.name);
}

void SceneReader::colour(const Key& key, std::array<double, 3>& value) {
  Eigen::Vector3d colour(value.data());
  vector(key, colour);
  require((colour.array() >= 0).all() && (colour.array() <= 1).all(), key.name,
          fmt::format("{} must be red, green and blue between 0 and 1", key.name));
  value = {colour[0], colour[1], colour[2]};
}

// One that has its length to rounding is kept bit for bit, so that a resolved scene reads back the same.
void SceneReader::direction(const Key& key, Eigen::Vector3d& value) {
  vector(key, value);
  const double length = safe_length(value);
  require(length > 0, key.name, fmt::format("{} must not be zero", key.name));
  if (std::abs(length - 1) > 1e-14) value /= length;
}

void SceneReader::box(const Key& key, std::optional<Box>& value) {
  const toml::node* node = find(key);
  if (!node) return;
  const toml::array* list = node->as_array();
  if (!list || list->size() != 2) fail(node->source(), fmt::format("{} must be [[x, y, z], [x, y, z]]", key.name));
  const Box box{three_numbers((*list)[0], key.name), three_numbers((*list)[1], key.name)};
  require((box.min.array() <= box.max.array()).all(), key.name,
          fmt::format("{} must be [[least x, y, z], [greatest x, y, z]]", key.name));
  value = box;
}

void SceneReader::axes(const Key& key, std::array<bool, 3>& value) {
  const toml::node* node = find(key);
  if (!node) return;
  const std::string letters = plain_text(*node, key.name);
  value = {false, false, false};
  for (char letter : letters) {
    const int axis = letter - 'x';
    require(axis >= 0 && axis <= 2 && !value[axis], key.name,
            fmt::format("{} '{}' must name each of x, y and z once at most", key.name, letters));
    value[axis] = true;
  }
}

void SceneReader::indices(const Key& key, std::vector<int>& value) {
  const toml::array* list = find_list(key, "integers");
  if (!list) return;
  value.clear();
  std::set<std::int64_t> seen;
  for (const toml::node& entry : *list) {
    if (!entry.is_integer()) fail(entry.source(), fmt::format("{} must hold integers, not {}", key.name, kind(entry)));
    const std::int64_t x = entry.as_integer()->get();
    if (x < 0 || x > std::numeric_limits<int>::max())
      fail(entry.source(), fmt::format("{} counts from 0, and {} is out of range", key.name, x));
    if (!seen.insert(x).second) fail(entry.source(), fmt::format("{} holds {} twice", key.name, x));
    value.push_back(static_cast<int>(x));
  }
}

void SceneReader::group(const Key& key, std::string& value) {
  const toml::node* node = find(key);
  if (!node) return;
  value = node->is_integer() ? std::to_string(node->as_integer()->get()) : plain_text(*node, key.name);
}

void SceneReader::path(const Key& key, std::filesystem::path& value) {
  const toml::node* node = find(key);
  if (!node) return;
  value = (file_.parent_path() / plain_text(*node, key.name)).lexically_normal();
  value = std::filesystem::absolute(value).lexically_normal();
  if (const auto elsewhere = moved_.find(value); elsewhere != moved_.end()) value = elsewhere->second;
}

void SceneReader::file(const Key& key, std::filesystem::path& value) {
  path(key, value);
  if (!given(key.name)) return;
  std::error_code error;
  require(std::filesystem::is_regular_file(value, error), key.name,
          fmt::format("{} '{}' is not a file that can be read", key.name, value.string()));
}

void SceneReader::require(bool good, std::string_view path, std::string_view sentence) {
  if (good) return;
  const toml::node* node = levels_.back().table;
  while (!path.empty()) {
    const std::string_view step = path.substr(0, path.find('.'));
    path.remove_prefix(std::min(path.size(), step.size() + 1));
    const toml::node* below = nullptr;
    if (const toml::table* table = node->as_table()) below = table->get(step);
    if (const toml::array* list = node->as_array()) {
      std::size_t index = 0;
      std::from_chars(step.data(), step.data() + step.size(), index);
      below = list->get(index);
    }
    if (!below) break;
    node = below;
  }
  fail(node->source(), sentence);
}

bool SceneReader::given(std::string_view key) const {
  return find(key) != nullptr;
}

void SceneReader::only_with(std::string_view key, std::string_view other) {
  require(!given(key) || given(other), key, fmt::format("{} means nothing without '{}'", key, other));
}

void SceneReader::step_into(const toml::node& node, const Key& key, bool list) {
  levels_.push_back({node.as_table(), levels_.back().path.below(key.name, list)});
  refuse_unknown();
  refuse_strange();
}

bool SceneReader::enter(const Key& key, bool, bool) {
  const toml::node* node = find(key);
  if (!node) return false;
  if (!node->is_table())
    fail(node->source(), fmt::format("{} must be a table, not {}: write {}", key.name, kind(*node),
                                     levels_.back().path.below(key.name, false).name()));
  step_into(*node, key, false);
  return true;
}

void SceneReader::leave() {
  levels_.pop_back();
}

std::size_t SceneReader::enter_list(const Key& key, std::size_t) {
  const toml::node* node = find(key.name);
  if (!node) return 0;
  const auto refuse = [&](const toml::node& at) {
    fail(at.source(), fmt::format("{} must be a list of tables, not {}: write {}", key.name, kind(at),
                                  levels_.back().path.below(key.name, true).name()));
  };
  if (!node->is_array()) refuse(*node);
  for (const toml::node& entry : *node->as_array())
    if (!entry.is_table()) refuse(entry);
  return node->as_array()->size();
}

void SceneReader::enter_item(const Key& key, std::size_t index) {
  step_into((*find(key.name)->as_array())[index], key, true);
}

std::size_t SceneReader::alternative(const Key& key, std::span<const std::string_view> kinds, std::size_t current) {
  const toml::node* node = find(key);
  if (!node) return current;
  const std::string_view kind = one_of(*node, key.name, kinds);
  return static_cast<std::size_t>(std::ranges::find(kinds, kind) - kinds.begin());
}

void SceneReader::chosen(const Key& key, std::span<const std::string_view> kinds, std::size_t index,
                         const DescribeOne& describe_one) {
  const TablePath& here = levels_.back().path;
  choices_.push_back({levels_.size(), std::string(key.name), std::string(kinds[index]), KeyList(here), {}});
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    KeyList list(here);
    describe_one(list, i);
    if (i == index)
      choices_.back().own = std::move(list);
    else
      choices_.back().others.push_back(std::move(list));
  }
  refuse_strange();
}

void SceneReader::end_alternative() {
  choices_.pop_back();
}

}  // namespace palpate
