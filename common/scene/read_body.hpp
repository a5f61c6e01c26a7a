#pragma once
#include "common/scene/scene.hpp"
#include "common/scene/table_reader.hpp"

namespace palpate {

/// Reads and validates one [[body]] table. Throws as TableReader does.
Body read_body(const TableReader& table);

/// Exactly one of `list_key`, `box` and `group`.
Selector read_selector(const TableReader& table, std::string_view list_key);

/// Fills dynamic, tearing and hybrid of a body whose model is read, and refuses what does not go with the
/// model.
void read_dynamics(const TableReader& table, Body& body);

/// A name that serves in file names and messages: 1 to 31 letters, digits, '_' or '-'.
void check_name(const TableReader& table, const std::string& name);

}  // namespace palpate
