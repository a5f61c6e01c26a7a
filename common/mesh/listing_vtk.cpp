#include <fmt/format.h>

#include <map>
#include <stdexcept>

#include "common/mesh/lister.hpp"

namespace palpate {
namespace {

int gmsh_type_of_vtk(int type) {
  static const std::map<int, int> types{{1, 15}, {3, 1},  {5, 2},  {9, 3},  {10, 4}, {12, 5},
                                        {13, 6}, {14, 7}, {21, 8}, {22, 9}, {24, 11}};
  const auto place = types.find(type);
  if (place == types.end()) throw std::runtime_error(fmt::format("VTK cell type {} is not known", type));
  return place->second;
}

void list_vtk_points(FileCursor& cursor, Lister& lister) {
  expect_section(cursor, "POINTS", "point list");
  const std::size_t points = cursor.text_count("points");
  const std::string_view real = cursor.word();
  if (real != "double" && real != "float") throw std::runtime_error("its points are neither double nor float");
  cursor.rest_of_line();
  const bool single = real == "float" && cursor.binary;  // as text, numbers have the digits that they have
  lister.reserve_nodes(points);
  for (std::size_t i = 0; i < points; ++i) {
    lister.add_node(i, single ? take_point<float>(cursor) : take_point<double>(cursor));
  }
}

}  // namespace

void list_vtk(FileCursor& cursor, Lister& lister) {
  const std::string version(cursor.rest_of_line());
  if (version.find("Version 5") != std::string::npos) {
    throw std::runtime_error("VTK files of version 5 are not read; save it as version 4.2 or as Gmsh 4.1");
  }
  cursor.rest_of_line();
  cursor.binary = cursor.word() == "BINARY";
  cursor.swapped = true;
  expect_section(cursor, "DATASET UNSTRUCTURED_GRID", "unstructured grid");
  const bool binary = cursor.binary;
  list_vtk_points(cursor, lister);

  expect_section(cursor, "CELLS", "cell list");
  const std::size_t cells = cursor.text_count("cells");
  cursor.text_count("cell entries");
  cursor.rest_of_line();
  FileCursor nodes = cursor;  // the types stand behind the nodes
  expect_section(cursor, "CELL_TYPES", "list of cell types");
  if (cursor.text_count("cell types") != cells) throw std::runtime_error("it has not as many cell types as cells");
  if (binary) cursor.rest_of_line();
  for (std::size_t i = 0; i < cells; ++i) {
    const int type = gmsh_type_of_vtk(cursor.number<int>());
    const std::size_t given = nodes.count<int>("nodes of a cell");
    if (given != static_cast<std::size_t>(element_type(type).nodes)) {
      throw std::runtime_error(fmt::format("cell {} has {} nodes, which does not fit its type", i, given));
    }
    lister.add_element<int>(nodes, type, 0, 0, given);
  }
  for (auto& number : lister.listing.node_numbers) ++number;
}

}  // namespace palpate
