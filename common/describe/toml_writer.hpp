#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/describe/description.hpp"
#include "common/describe/table_name.hpp"

namespace palpate {

/// Writes a spec as TOML, every default written out; what is empty is left out. Hashes take the digest of such a text:
/// they derive, leave keys out, and write a file's contents in the place of its path.
class TomlWriter : public Description {
 public:
  TomlWriter() : tables_{{}} {}
  std::string text() const;

  void number(const Key& key, double& value, const Range& range) override;
  void numbers(const Key& key, std::vector<double>& value, const Range& range) override;
  void integer(const Key& key, int& value, int low, int high) override;
  void flag(const Key& key, bool& value) override;
  void text(const Key& key, std::string& value) override;
  void name(const Key& key, std::string& value) override { text(key, value); }
  void texts(const Key& key, std::vector<std::string>& value) override;
  void choice(const Key& key, std::string& value, std::span<const std::string_view> allowed) override;
  void vector(const Key& key, Eigen::Vector3d& value) override;
  void colour(const Key& key, std::array<double, 3>& value) override;
  void direction(const Key& key, Eigen::Vector3d& value) override { vector(key, value); }
  void box(const Key& key, std::optional<Box>& value) override;
  void axes(const Key& key, std::array<bool, 3>& value) override;
  void indices(const Key& key, std::vector<int>& value) override;
  void group(const Key& key, std::string& value) override { text(key, value); }
  void path(const Key& key, std::filesystem::path& value) override;
  void file(const Key& key, std::filesystem::path& value) override { path(key, value); }
  void only_with(std::string_view key, std::string_view other) override;
  bool writes() const override { return true; }

 protected:
  /// Whether the key is written at all, or the table.
  virtual bool takes(const Key& /*key*/) const { return true; }
  virtual bool takes_table(const Key& /*key*/) const { return true; }
  /// Whether a table without a line is written.
  virtual bool takes_empty_tables() const { return true; }
  void line(const Key& key, std::string value);

  bool enter(const Key& key, bool present, bool optional) override;
  void leave() override;
  std::size_t enter_list(const Key& /*key*/, std::size_t count) override { return count; }
  void enter_item(const Key& key, std::size_t index) override;
  std::size_t alternative(const Key& key, std::span<const std::string_view> kinds, std::size_t current) override;

 private:
  struct Table {
    TablePath path;
    bool taken = true;
    std::vector<std::pair<std::string, std::string>> lines;  ///< key, value
    std::string below;                                       ///< text of the tables in it
  };
  static std::string text_of(const Table& table);

  std::vector<Table> tables_;  ///< the one being written, and those around it
};

}  // namespace palpate
