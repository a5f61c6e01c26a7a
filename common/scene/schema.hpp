#pragma once
#include <span>
#include <string_view>
#include <vector>

namespace palpate {

/// One kind of table in a scene file and the keys it may hold; docs/scene.md lists the same.
struct TableSchema {
  std::string_view name;  ///< as written: `[[body]]`, `[contact]`; the top of the file is `scene`
  std::vector<std::string_view> keys;
};

/// Every table of a scene file, in the order of the reference.
std::span<const TableSchema> scene_schema();

/// The schema of one table. Throws std::logic_error if there is none of that name.
const TableSchema& table_schema(std::string_view name);

/// The candidate with the fewest single-letter changes from `word`; empty if none is near.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace palpate
