#include "tools/solution_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
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

using Vectors = std::vector<Eigen::Vector3d>;

/// Those that are told, in the order of the columns.
std::vector<const Vectors*> told(const SolutionTable& table) {
  std::vector<const Vectors*> fields{&table.position, &table.displacement};
  for (const Vectors* more : {&table.force, &table.velocity})
    if (!more->empty()) fields.push_back(more);
  return fields;
}

std::string cell_data(const std::vector<Eigen::Matrix3d>& stress) {
  if (stress.empty()) return {};
  std::vector<std::string> lines;
  std::vector<double> von_mises;
  for (const Eigen::Matrix3d& s : stress) {
    lines.push_back(fmt::format("{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}", s(0, 0), s(1, 1), s(2, 2), s(0, 1),
                                s(1, 2), s(0, 2)));
    const Eigen::Matrix3d shear = s - s.trace() / 3 * Eigen::Matrix3d::Identity();
    von_mises.push_back(std::sqrt(1.5) * shear.norm());
  }
  return "<CellData>\n" + data_array("Float64", "stress", 6, lines) + data_array("Float64", "von_mises", 1, von_mises) +
         "</CellData>\n";
}

}  // namespace

std::string csv_columns(const SolutionTable& table) {
  std::string columns = "node,x,y,z,ux,uy,uz";
  if (!table.force.empty()) columns += ",fx,fy,fz";
  if (!table.velocity.empty()) columns += ",vx,vy,vz";
  return columns;
}

std::string csv_lines(const SolutionTable& table, std::string_view before) {
  std::string text;
  const std::vector<const Vectors*> fields = told(table);
  for (std::size_t i = 0; i < table.node.size(); ++i) {
    if (!table.listed.empty() && !table.listed[i]) continue;
    fmt::format_to(std::back_inserter(text), "{}{}", before, table.node[i]);
    for (const Vectors* field : fields)
      for (double value : (*field)[i]) fmt::format_to(std::back_inserter(text), ",{:.17g}", value);
    text += '\n';
  }
  return text;
}

void write_csv(const SolutionTable& table, const std::filesystem::path& file) {
  write_text(csv_columns(table) + "\n" + csv_lines(table), file);
}

void write_vtu(const SolutionTable& table, const std::filesystem::path& file) {
  const std::size_t count = table.tetrahedra.size() + table.triangles.size();
  const auto grid =
      table.triangles.empty() ? cells(table.tetrahedra, kVtkTetrahedron) : cells(table.triangles, kVtkTriangle);
  std::string points = data_array("Float64", "displacement", 3, vectors(table.displacement));
  if (!table.force.empty()) points += data_array("Float64", "force", 3, vectors(table.force));
  if (!table.velocity.empty()) points += data_array("Float64", "velocity", 3, vectors(table.velocity));
  write_text(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
      "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n" +
          fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n", table.node.size(), count) +
          data_array("Float64", "position", 3, vectors(table.position)) + "</Points>\n" + grid +
          "<PointData Vectors=\"displacement\">\n" + points + data_array("Int32", "node", 1, table.node) +
          "</PointData>\n" + cell_data(table.stress) + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
      file);
}

}  // namespace palpate
