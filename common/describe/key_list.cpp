#include "common/describe/key_list.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/describe/value_text.hpp"

namespace palpate {
namespace {

std::string code(std::string_view text) {
  return text.empty() ? std::string() : fmt::format("`{}`", text);
}

std::string short_number(double x) {
  return fmt::format("{}", x);
}

std::string short_vector(const double* v) {
  return fmt::format("`[{}, {}, {}]`", v[0] + 0.0, v[1] + 0.0, v[2] + 0.0);  // no negative zero
}

void note_table(DescribedKey& row, const TablePath& path) {
  if (!row.is_table) row.meaning += fmt::format(", `{}`", path.name());
  row.is_table = true;
}

}  // namespace

const DescribedKey* DescribedTable::find(std::string_view key) const {
  const auto found = std::ranges::find(keys, key, &DescribedKey::name);
  return found == keys.end() ? nullptr : &*found;
}

KeyList::KeyList(TablePath top) {
  tables_.push_back({std::move(top), {}});
  inside_.push_back(0);
}

const DescribedTable* KeyList::find(const std::string& path) const {
  const auto found =
      std::ranges::find_if(tables_, [&](const DescribedTable& table) { return table.path.path == path; });
  return found == tables_.end() ? nullptr : &*found;
}

// A key that several alternatives have is one row, which says what differs.
DescribedKey& KeyList::enter_key(const Key& key, std::string type, std::string fallback) {
  if (!key.fallback.empty()) fallback = key.fallback;
  if (key.need == Need::required) fallback = "needed";
  const bool of_kind = !kind_.empty() && kind_at_.back() == inside_.size();
  auto& keys = current().keys;
  const std::string meaning = (key.unit.empty() ? "" : fmt::format("[{}] ", key.unit)) + std::string(key.meaning);
  auto found = std::ranges::find(keys, key.name, &DescribedKey::name);
  if (found == keys.end()) {
    keys.push_back({std::string(key.name), std::move(type), fallback, meaning, key.use});
    found = keys.end() - 1;
  } else if (of_kind) {
    if (found->fallback.substr(0, found->fallback.find(';')) != fallback)
      found->fallback += fmt::format("; {} for `{}`", fallback, kind_.back().second);
    if (found->meaning.find(meaning) == std::string::npos)
      found->meaning += fmt::format("; for `{}`: {}", kind_.back().second, meaning);
  }
  if (of_kind) {
    found->kinds.push_back(kind_.back().second);
    found->of_kinds = kinds_of_.find(kind_.back().first)->second;
  }
  return *found;
}

void KeyList::number(const Key& key, double& value, const Range& range) {
  enter_key(key, "number" + range.signs(), short_number(value));
}

void KeyList::numbers(const Key& key, std::vector<double>&, const Range& range) {
  enter_key(key, "list of numbers" + range.signs(), "none");
}

void KeyList::integer(const Key& key, int& value, int low, int high) {
  enter_key(key, fmt::format("integer, {} to {}", low, high), std::to_string(value));
}

void KeyList::flag(const Key& key, bool& value) {
  enter_key(key, "true or false", value ? "`true`" : "`false`");
}

void KeyList::text(const Key& key, std::string& value) {
  enter_key(key, "text", value.empty() ? "none" : code(value));
}

void KeyList::name(const Key& key, std::string& value) {
  text(key, value);
}

void KeyList::texts(const Key& key, std::vector<std::string>&) {
  enter_key(key, "list of texts", "none");
}

void KeyList::choice(const Key& key, std::string& value, std::span<const std::string_view> allowed) {
  std::string type;
  for (std::string_view word : allowed) type += fmt::format("{}`\"{}\"`", type.empty() ? "" : ", ", word);
  enter_key(key, type, fmt::format("`\"{}\"`", value));
}

void KeyList::vector(const Key& key, Eigen::Vector3d& value) {
  enter_key(key, "`[x, y, z]`", short_vector(value.data()));
}

void KeyList::colour(const Key& key, std::array<double, 3>& value) {
  enter_key(key, "`[r, g, b]`", short_vector(value.data()));
}

void KeyList::direction(const Key& key, Eigen::Vector3d& value) {
  vector(key, value);
}

void KeyList::box(const Key& key, std::optional<Box>&) {
  enter_key(key, "`[[x, y, z], [x, y, z]]`", "none");
}

void KeyList::axes(const Key& key, std::array<bool, 3>& value) {
  enter_key(key, "text", code(value_text::axes(value)));
}

void KeyList::indices(const Key& key, std::vector<int>&) {
  enter_key(key, "list of integers", "none");
}

void KeyList::group(const Key& key, std::string&) {
  enter_key(key, "text or integer", "none");
}

void KeyList::path(const Key& key, std::filesystem::path&) {
  enter_key(key, "path", "none");
}

void KeyList::file(const Key& key, std::filesystem::path& value) {
  path(key, value);
}

void KeyList::step_into(const Key& key, bool list) {
  const TablePath path = current().path.below(key.name, list);
  const auto known = std::ranges::find_if(tables_, [&](const DescribedTable& t) { return t.path.path == path.path; });
  inside_.push_back(static_cast<std::size_t>(known - tables_.begin()));
  if (known == tables_.end()) tables_.push_back({path, {}});
}

bool KeyList::enter(const Key& key, bool, bool) {
  note_table(enter_key(key, "table", "none"), current().path.below(key.name, false));
  step_into(key, false);
  return true;
}

std::size_t KeyList::enter_list(const Key& key, std::size_t) {
  note_table(enter_key(key, "list of tables", "none"), current().path.below(key.name, true));
  return 1;
}

void KeyList::enter_item(const Key& key, std::size_t) {
  step_into(key, true);
}

void KeyList::leave() {
  inside_.pop_back();
}

std::size_t KeyList::alternative(const Key& key, std::span<const std::string_view> kinds, std::size_t current) {
  std::string type;
  for (std::string_view kind : kinds) type += fmt::format("{}`\"{}\"`", type.empty() ? "" : ", ", kind);
  enter_key(key, type, fmt::format("`\"{}\"`", kinds[current]));
  kinds_of_[std::string(key.name)] = kinds.size();
  return current;
}

void KeyList::begin_alternative(const Key& key, std::string_view kind) {
  kind_.emplace_back(key.name, kind);
  kind_at_.push_back(inside_.size());
}

void KeyList::end_alternative() {
  kind_.pop_back();
  kind_at_.pop_back();
}

}  // namespace palpate
