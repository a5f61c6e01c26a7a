#include "tools/solution_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <stdexcept>

namespace palpate {
namespace {

constexpr int kVtkTriangle = 5, kVtkTetrahedron = 10;

void write_text(const std::string& text, const std::filesystem::path& file) {
  std::FILE* stream = std::fopen(file.c_str(), "w");
  bool done = stream && std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  if (stream) done = std::fclose(stream) == 0 && done;
  if (!done) throw std::runtime_error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
}

template <class Values>
std::string data_array(const char* type, const char* name, int components, const Values& values) {
  auto text = fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\">\n", type,
                          name, components);
  for (const auto& value : values) fmt::format_to(std::back_inserter(text), "{}\n", value);
  return text + "</DataArray>\n";
}

std::vector<std::string> vectors(const std::vector<Eigen::Vector3d>& field) {
  std::vector<std::string> lines;
  for (const auto& v : field) lines.push_back(fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z()));
  return lines;
}

template <std::size_t Corners>
std::string cells(const std::vector<std::array<int, Corners>>& elements, int type) {
  std::vector<int> connectivity, offsets;
  for (const auto& element : elements) {
    connectivity.insert(connectivity.end(), element.begin(), element.end());
    offsets.push_back(static_cast<int>(connectivity.size()));
  }
  return "<Cells>\n" + data_array("Int32", "connectivity", 1, connectivity) +
         data_array("Int32", "offsets", 1, offsets) +
         data_array("UInt8", "types", 1, std::vector<int>(elements.size(), type)) + "</Cells>\n";
}

}  // namespace

void write_csv(const SolutionTable& table, const std::filesystem::path& file) {
  std::string text = "node,x,y,z,ux,uy,uz,fx,fy,fz\n";
  for (std::size_t i = 0; i < table.node.size(); ++i) {
    if (!table.listed.empty() && !table.listed[i]) continue;
    fmt::format_to(std::back_inserter(text), "{}", table.node[i]);
    for (const auto* field : {&table.position, &table.displacement, &table.force})
      for (double value : (*field)[i]) fmt::format_to(std::back_inserter(text), ",{:.17g}", value);
    text += '\n';
  }
  write_text(text, file);
}

void write_vtu(const SolutionTable& table, const std::filesystem::path& file) {
  const std::size_t count = table.tetrahedra.size() + table.triangles.size();
  const auto grid =
      table.triangles.empty() ? cells(table.tetrahedra, kVtkTetrahedron) : cells(table.triangles, kVtkTriangle);
  write_text(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n" +
          fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n", table.node.size(), count) +
          data_array("Float64", "position", 3, vectors(table.position)) + "</Points>\n" + grid +
          "<PointData Vectors=\"displacement\">\n" +
          data_array("Float64", "displacement", 3, vectors(table.displacement)) +
          data_array("Float64", "force", 3, vectors(table.force)) + data_array("Int32", "node", 1, table.node) +
          "</PointData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
      file);
}

}  // namespace palpate
