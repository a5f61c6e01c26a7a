#include "tools/organ/surface_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

#include "common/files/ending.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tools/organ/polydata_file.hpp"
#include "tools/organ/stl_file.hpp"
#include "tools/organ/surface_extent.hpp"
#include "tools/organ/surface_library.hpp"
#include "tools/organ/vtp_file.hpp"

namespace palpate {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& reason) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), reason));
}

std::string text_of(const fs::path& file) {
  if (!fs::exists(file)) refuse(file, "the file does not exist");
  if (!fs::is_regular_file(file)) refuse(file, "this is not a file");
  std::ifstream in(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  if (!in) refuse(file, "the file cannot be read");
  return text;
}

/// Fans of triangles.
ReadSurface triangles_of(const Polygons& read) {
  ReadSurface surface{{read.points, {}}, {}};
  std::size_t larger = 0;
  for (const auto& polygon : read.polygons) {
    larger += polygon.size() > 3;
    for (std::size_t c = 2; c < polygon.size(); ++c)
      surface.mesh.triangles.push_back({polygon[0], polygon[c - 1], polygon[c]});
  }
  if (larger > 0)
    surface.findings.push_back({fmt::format("{} polygons of more than three sides", larger), "cut into triangles", {}});
  return surface;
}

/// Lines of an OBJ file that say nothing of polygons, which the library passes over or refuses.
std::vector<Finding> strange_lines(const std::string& obj) {
  static const std::set<std::string, std::less<>> known{"v", "vn", "vt", "vp",     "f",     "o",
                                                        "g", "s",  "mg", "mtllib", "usemtl"};
  std::istringstream lines(obj);
  std::string line, word, first;
  int count = 0;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (!(std::istringstream(line) >> word) || word[0] == '#' || known.contains(word)) continue;
    if (count++ == 0) first = fmt::format("{}, '{:.20}'", number, word);
  }
  if (count == 0) return {};
  return {{fmt::format("lines that say nothing of polygons ({}), the first line {}", count, first), "passed over", {}}};
}

/// Names of groups of an OBJ file's triangles, which the library passes over.
std::vector<Finding> group_names(const std::string& obj) {
  std::istringstream lines(obj);
  std::set<std::string> names;
  std::string line, word, name, first;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    if (!(words >> word) || word != "g" || !(words >> name) || !names.insert(name).second) continue;
    if (names.size() == 1) first = name;
  }
  if (names.empty()) return {};
  return {{fmt::format("groups of triangles ({}), the first '{:.40}'", names.size(), first),
           "not kept: --group names nodes by their place",
           {}}};
}

ReadSurface read(const fs::path& file) {
  if (has_ending(file, ".stl")) return read_stl(text_of(file));
  if (has_ending(file, ".vtp")) return triangles_of(read_vtp(text_of(file)));
  if (has_ending(file, ".vtk"))
    if (const std::string text = text_of(file); is_polydata(text)) return triangles_of(read_polydata(text));
  if (has_ending(file, ".vtk")) return {load_triangle_mesh(file, 1), {}};
  if (!has_ending(file, ".obj") && !has_ending(file, ".ply") && !has_ending(file, ".off"))
    refuse(file, "a surface is read from .stl, .obj, .ply, .off, .vtk and .vtp files");
  const std::string text = text_of(file);
  ReadSurface surface = triangles_of(read_with_surface_library(file));
  if (has_ending(file, ".obj"))
    for (const auto& found : {strange_lines(text), group_names(text)})
      surface.findings.insert(surface.findings.end(), found.begin(), found.end());
  return surface;
}

}  // namespace

ReadSurface read_surface(const fs::path& file, double scale) try {
  ReadSurface surface = read(file);
  if (surface.mesh.triangles.empty()) refuse(file, "it has no triangles");
  for (Eigen::Vector3d& x : surface.mesh.nodes) x *= scale;
  for (std::size_t t = 0; t < surface.mesh.triangles.size(); ++t)
    for (const int n : surface.mesh.triangles[t])
      if (!surface.mesh.nodes[n].allFinite())
        refuse(file, fmt::format("triangle {} has a coordinate that is not a finite number", t));
  check_extent(surface.mesh);
  return surface;
} catch (const std::runtime_error& error) {
  const std::string said = error.what();
  if (said.starts_with(file.string())) throw;
  refuse(file, said);
}

}  // namespace palpate
