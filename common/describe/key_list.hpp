#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/describe/description.hpp"
#include "common/describe/table_name.hpp"

namespace palpate {

/// One key of a table, for those who read or write about it.
struct DescribedKey {
  std::string name;
  std::string type;                ///< "number > 0"
  std::string fallback;            ///< what holds where it is absent, "needed" if it must not be
  std::string meaning;             ///< with its unit
  Use use = Use::agreed;           ///< who depends on it
  std::vector<std::string> kinds;  ///< alternatives that have it; empty: it is outside of any
  std::size_t of_kinds = 0;        ///< how many alternatives there are
  bool is_table = false;
};

/// One kind of table and the keys it may hold.
struct DescribedTable {
  TablePath path;
  std::vector<DescribedKey> keys;

  const DescribedKey* find(std::string_view key) const;
};

/// Collects every key of a spec, those of every alternative of its variants.
class KeyList : public Description {
 public:
  /// `top`: where the spec's own table stands.
  explicit KeyList(TablePath top = {});

  /// Tables in the order in which they are described, the spec's own first.
  const std::vector<DescribedTable>& tables() const { return tables_; }
  const DescribedTable* find(const std::string& path) const;

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

 protected:
  bool enter(const Key& key, bool present, bool optional) override;
  void leave() override;
  std::size_t enter_list(const Key& key, std::size_t count) override;
  void enter_item(const Key& key, std::size_t index) override;
  std::size_t alternative(const Key& key, std::span<const std::string_view> kinds, std::size_t current) override;
  bool wants_every_alternative() const override { return true; }
  void begin_alternative(const Key& key, std::string_view kind) override;
  void end_alternative() override;

 private:
  DescribedTable& current() { return tables_[inside_.back()]; }
  DescribedKey& enter_key(const Key& key, std::string type, std::string fallback);
  void step_into(const Key& key, bool list);

  std::vector<DescribedTable> tables_;
  std::map<std::string, std::size_t, std::less<>> kinds_of_;  ///< alternatives per variant, by its key
  std::vector<std::size_t> inside_;                           ///< the table being described, and those around it
  std::vector<std::pair<std::string, std::string>> kind_;     ///< key and kind of the alternative, and those around it
  std::vector<std::size_t> kind_at_;                          ///< the depth of tables at which each began
};

}  // namespace palpate
