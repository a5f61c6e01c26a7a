#pragma once
#include <toml++/toml.h>

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/scene/schema.hpp"

namespace palpate {

/// Bounds of a number.
struct Range {
  double low, high;
  bool low_allowed, high_allowed;
};
Range above(double low);                         ///< low < x
Range at_least(double low);                      ///< low <= x
Range within(double low, double high);           ///< low <= x <= high
Range strictly_within(double low, double high);  ///< low < x < high

enum class Need { optional, required };

/// Reads one table of a scene file against its schema. Every reading function leaves `value`, which holds the
/// default, untouched when the key is absent and not required. Everything wrong throws
/// std::runtime_error("FILE:LINE:COLUMN: sentence") with the place of the key or value; an absent required
/// key has the place of its table.
class TableReader {
 public:
  /// Refuses keys that the schema `name` does not list. `file` is the scene's, for messages and relative
  /// paths.
  TableReader(const toml::table& table, std::string_view name, const std::filesystem::path& file);

  bool has(std::string_view key) const;

  void number(std::string_view key, double& value, const Range& range, Need need = Need::optional) const;
  void integer(std::string_view key, int& value, int low, int high, Need need = Need::optional) const;
  void flag(std::string_view key, bool& value) const;
  void text(std::string_view key, std::string& value, Need need = Need::optional) const;
  void choice(std::string_view key, std::string& value, const std::vector<std::string_view>& allowed) const;
  void texts(std::string_view key, std::vector<std::string>& value) const;
  /// A physical group: its name, or its number, which becomes text.
  void group(std::string_view key, std::string& value) const;
  void vector(std::string_view key, Eigen::Vector3d& value, Need need = Need::optional) const;
  /// [[x, y, z], [x, y, z]]
  std::array<Eigen::Vector3d, 2> vector_pair(std::string_view key) const;
  /// Non-empty list of different numbers, 0 or greater.
  void indices(std::string_view key, std::vector<int>& value) const;
  /// Path relative to the scene file, made absolute.
  void path(std::string_view key, std::filesystem::path& value, Need need = Need::optional) const;
  /// The same, of a file that exists.
  void existing_file(std::string_view key, std::filesystem::path& value, Need need = Need::optional) const;

  std::optional<TableReader> table(std::string_view key, std::string_view name) const;
  std::vector<TableReader> tables(std::string_view key, std::string_view name) const;

  [[noreturn]] void fail(std::string_view sentence) const;                           ///< at the table
  [[noreturn]] void fail_at(std::string_view key, std::string_view sentence) const;  ///< at the key's value

 private:
  const toml::node* find(std::string_view key, Need need) const;
  [[noreturn]] void fail(const toml::source_region& where, std::string_view sentence) const;
  double finite_number(const toml::node& node, std::string_view what) const;
  Eigen::Vector3d three_numbers(const toml::node& node, std::string_view what) const;
  std::string plain_text(const toml::node& node, std::string_view what) const;

  const toml::table* table_;
  const TableSchema* schema_;
  const std::filesystem::path* file_;
};

}  // namespace palpate
