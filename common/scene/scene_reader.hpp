#pragma once
#include <toml++/toml.h>

#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/describe/key_list.hpp"
#include "common/scene/moved_files.hpp"

namespace palpate {

/// Reads a TOML table into a spec that holds its defaults. Everything wrong throws
/// std::runtime_error("FILE:LINE:COLUMN: sentence") with the place of the key or value; an absent required key has the
/// place of its table.
class SceneReader : public Description {
 public:
  /// `known`: all keys of the spec. `file` is the scene's, for messages and relative paths.
  /// `moved`: where files lie that the text says are elsewhere.
  SceneReader(const toml::table& table, const KeyList& known, std::filesystem::path file, const MovedFiles& moved = {});

  void number(const Key& key, double& value, const Range& range) override;
  void numbers(const Key& key, std::vector<double>& value, const Range& range) override;
  void integer(const Key& key, int& value, int low, int high) override;
  void flag(const Key& key, bool& value) override;
  void text(const Key& key, std::string& value) override;
  void name(const Key& key, std::string& value) override;
  void texts(const Key& key, std::vector<std::string>& value) override;
  void choice(const Key& key, std::string& value, std::span<const std::string_view> allowed) override;
  void vector(const Key& key, Eigen::Vector3d& value) override;
  void colour(const Key& key, std::array<double, 3>& value) override;
  void direction(const Key& key, Eigen::Vector3d& value) override;
  void box(const Key& key, std::optional<Box>& value) override;
  void axes(const Key& key, std::array<bool, 3>& value) override;
  void indices(const Key& key, std::vector<int>& value) override;
  void group(const Key& key, std::string& value) override;
  void path(const Key& key, std::filesystem::path& value) override;
  void file(const Key& key, std::filesystem::path& value) override;
  void require(bool good, std::string_view path, std::string_view sentence) override;
  bool given(std::string_view key) const override;
  void only_with(std::string_view key, std::string_view other) override;

 protected:
  bool enter(const Key& key, bool present, bool optional) override;
  void leave() override;
  std::size_t enter_list(const Key& key, std::size_t count) override;
  void enter_item(const Key& key, std::size_t index) override;
  std::size_t alternative(const Key& key, std::span<const std::string_view> kinds, std::size_t current) override;
  void chosen(const Key& key, std::span<const std::string_view> kinds, std::size_t index,
              const DescribeOne& describe_one) override;
  void end_alternative() override;

 private:
  struct Level {
    const toml::table* table;
    TablePath path;
  };
  /// An alternative that was chosen, and what belongs to it and to the others.
  struct Choice {
    std::size_t depth;
    std::string key, kind;
    KeyList own;
    std::vector<KeyList> others;

    bool strange(const std::string& path, std::string_view key) const;
  };

  const toml::node* find(std::string_view key) const { return levels_.back().table->get(key); }
  const toml::node* find(const Key& key) const;
  /// One that is not empty; null where the key is not given. `of`: what it holds, in the plural.
  const toml::array* find_list(const Key& key, const char* of) const;
  void step_into(const toml::node& node, const Key& key, bool list);
  void refuse_unknown() const;
  void refuse_strange() const;
  [[noreturn]] void refuse_missing(const Key& key) const;
  [[noreturn]] void fail(const toml::source_region& where, std::string_view sentence) const;
  [[noreturn]] void fail_at(std::string_view key, std::string_view sentence) const;
  double finite_number(const toml::node& node, std::string_view what) const;
  Eigen::Vector3d three_numbers(const toml::node& node, std::string_view what) const;
  std::string plain_text(const toml::node& node, std::string_view what) const;
  std::string_view one_of(const toml::node& node, std::string_view what,
                          std::span<const std::string_view> allowed) const;

  const KeyList& known_;
  std::filesystem::path file_;
  MovedFiles moved_;
  std::vector<Level> levels_;
  std::vector<Choice> choices_;
};

}  // namespace palpate
