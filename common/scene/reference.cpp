#include "common/scene/reference.hpp"

#include <fmt/format.h>

#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace palpate {
namespace {

/// The kinds that lack the key, as far as the table's other keys tell; empty where that is not clear.
std::vector<std::string> kinds_without(const DescribedKey& key, const DescribedTable& table) {
  std::set<std::string> kinds;
  for (const DescribedKey& other : table.keys)
    if (other.of_kinds == key.of_kinds) kinds.insert(other.kinds.begin(), other.kinds.end());
  if (kinds.size() != key.of_kinds) return {};
  for (const std::string& kind : key.kinds) kinds.erase(kind);
  return {kinds.begin(), kinds.end()};
}

std::string whose(const DescribedKey& key, const DescribedTable& table) {
  if (key.kinds.empty() || key.kinds.size() == key.of_kinds) return {};
  const auto without = kinds_without(key, table);
  if (!without.empty() && without.size() < key.kinds.size())
    return fmt::format(" (not `{}`)", fmt::join(without, "`, `"));
  return fmt::format(" (`{}` alone)", fmt::join(key.kinds, "`, `"));
}

std::string row(const DescribedKey& key, const DescribedTable& table) {
  const std::string meaning = key.meaning + whose(key, table);
  return fmt::format("| `{}` | {} | {} | {} |\n", key.name, key.type, key.fallback, meaning);
}

std::string table_text(const DescribedTable& table) {
  std::string text = "| key | type | default | meaning |\n| --- | --- | --- | --- |\n";
  for (const DescribedKey& key : table.keys) text += row(key, table);
  return text;
}

/// The name in "## `NAME`: ..."; empty for other lines.
std::string heading(const std::string& line) {
  if (!line.starts_with("## `")) return {};
  return line.substr(4, line.find('`', 4) - 4);
}

}  // namespace

std::string with_reference(const std::string& page, const KeyList& keys) {
  std::set<std::string> missing;
  for (const DescribedTable& table : keys.tables())
    if (!table.keys.empty()) missing.insert(table.path.name());
  std::istringstream lines(page);
  std::string out, waiting;  // waiting: the heading whose table has not come yet
  bool replaced = false;     // within the rows of an old table
  for (std::string line; std::getline(lines, line);) {
    const std::string name = heading(line);
    if (!name.empty()) waiting = name;
    const bool in_table = line.starts_with("|");
    if (in_table && missing.erase(waiting) > 0) {
      for (const DescribedTable& table : keys.tables())
        if (table.path.name() == waiting) out += table_text(table);
      replaced = true;
    }
    if (!in_table) replaced = false;
    if (!replaced) out += line + "\n";
  }
  if (!missing.empty())
    throw std::runtime_error(fmt::format("the page has no table below a heading '## `{}`'", *missing.begin()));
  return out;
}

}  // namespace palpate
