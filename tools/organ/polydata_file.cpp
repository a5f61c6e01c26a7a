#include "tools/organ/polydata_file.hpp"

#include <fmt/format.h>

#include "common/mesh/file_cursor.hpp"

namespace palpate {
namespace {

/// Moves behind the count of a section; 0 where there is no such section.
std::size_t find_section(FileCursor& cursor, std::string_view name) {
  return cursor.seek_line(name) ? cursor.text_count("entries") : 0;
}

template <class Real>
void take_points(FileCursor& cursor, std::size_t count, Polygons& read) {
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d x;
    for (int a = 0; a < 3; ++a) x[a] = static_cast<double>(cursor.number<Real>());
    read.points.push_back(x);
  }
}

std::vector<int> take_polygon(FileCursor& cursor, std::size_t points) {
  std::vector<int> polygon;
  for (std::size_t left = cursor.count<int>("corners of a polygon"); left > 0; --left) {
    const int n = cursor.number<int>();
    if (n < 0 || static_cast<std::size_t>(n) >= points)
      throw std::runtime_error(fmt::format("a polygon names point {}, of {}", n, points));
    polygon.push_back(n);
  }
  return polygon;
}

/// Cells of a section that stands anywhere behind the cursor.
std::vector<std::vector<int>> take_section(FileCursor cursor, std::string_view name, std::size_t points) {
  const std::size_t count = find_section(cursor, name);
  cursor.rest_of_line();
  std::vector<std::vector<int>> cells;
  for (std::size_t i = 0; i < count; ++i) cells.push_back(take_polygon(cursor, points));
  return cells;
}

}  // namespace

bool is_polydata(std::string_view bytes) {
  return FileCursor(bytes).seek_line("DATASET POLYDATA");
}

Polygons read_polydata(std::string_view bytes) {
  FileCursor cursor(bytes);
  const std::string_view version = cursor.rest_of_line();
  if (version.find("Version 5") != std::string_view::npos)
    throw std::runtime_error("VTK files of version 5 are not read; save it as version 4.2 or as VTP");
  cursor.rest_of_line();
  cursor.binary = cursor.word() == "BINARY";
  cursor.swapped = true;
  Polygons read;
  const std::size_t points = find_section(cursor, "POINTS");
  const std::string_view real = points > 0 ? cursor.word() : "none";
  if (real != "double" && real != "float") throw std::runtime_error("its points are neither double nor float");
  cursor.rest_of_line();
  if (real == "float" && cursor.binary)
    take_points<float>(cursor, points, read);
  else
    take_points<double>(cursor, points, read);
  for (const std::vector<int>& polygon : take_section(cursor, "POLYGONS", points)) read.polygons.push_back(polygon);
  for (const std::vector<int>& strip : take_section(cursor, "TRIANGLE_STRIPS", points)) read.add_strip(strip);
  return read;
}

}  // namespace palpate
