#pragma once
#include "common/scene/scene.hpp"
#include "common/scene/table_reader.hpp"

namespace palpate {

/// Reads and validates one [[body]] table. Throws as TableReader does.
Body read_body(const TableReader& table);

/// A name that serves in file names and messages: 1 to 31 letters, digits, '_' or '-'.
void check_name(const TableReader& table, const std::string& name);

}  // namespace palpate
