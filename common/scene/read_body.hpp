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

/// The same for shell and catheter; fills what a catheter has in place of a mesh.
void read_duct(const TableReader& table, Body& body);

/// Refuses a catheter that is led into anything but a modal_shell body. `bodies`: the tables of
/// `scene.bodies`.
void check_ducts(const std::vector<TableReader>& bodies, const Scene& scene);

/// Reads and validates one [[tool]] table.
Tool read_tool(const TableReader& table);

/// A name that serves in file names and messages: 1 to 31 letters, digits, '_' or '-'.
void check_name(const TableReader& table, const std::string& name);

}  // namespace palpate
