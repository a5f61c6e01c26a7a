#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/archive/condensed_tensors.hpp"
#include "common/archive/hdf5_file.hpp"

namespace palpate {

/// Rows of a few numbers as the flat arrays that archives keep, and back. Private to common/tensors.
template <class Row, class Convert>
auto flatten(const std::vector<Row>& rows, std::size_t columns, Convert convert) {
  std::vector<decltype(convert(rows[0], 0))> flat;
  flat.reserve(columns * rows.size());
  for (const auto& row : rows)
    for (std::size_t c = 0; c < columns; ++c) flat.push_back(convert(row, c));
  return flat;
}

template <class Row>
std::vector<std::int32_t> flatten_integers(const std::vector<Row>& rows) {
  return flatten(rows, std::tuple_size_v<Row>, [](const Row& row, std::size_t c) { return std::int32_t{row[c]}; });
}

inline std::vector<std::int32_t> flatten(const std::vector<Dof>& dofs) {
  return flatten(dofs, 2, [](const Dof& dof, std::size_t c) { return std::int32_t{c == 0 ? dof.node : dof.axis}; });
}

template <class Row, class Value>
std::vector<Row> rows_of(std::size_t columns, const std::vector<Value>& flat) {
  std::vector<Row> rows(flat.size() / columns);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t c = 0; c < columns; ++c) rows[i][c] = flat[columns * i + c];
  return rows;
}

inline std::vector<Dof> read_dofs(const Hdf5Reader& file, const std::string& name) {
  std::vector<Dof> dofs;
  for (const auto& [node, axis] : rows_of<std::array<int, 2>>(2, file.integers(name))) dofs.push_back({node, axis});
  return dofs;
}

}  // namespace palpate
