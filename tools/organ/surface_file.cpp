#include "tools/organ/surface_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "common/files/ending.hpp"
#include "common/mesh/mesh_file.hpp"
#include "tools/organ/obj_polygons.hpp"
#include "tools/organ/off_file.hpp"
#include "tools/organ/ply_file.hpp"
#include "tools/organ/polydata_file.hpp"
#include "tools/organ/stl_file.hpp"
#include "tools/organ/surface_extent.hpp"
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

ReadSurface triangles_of(const Polygons& read) {
  ReadSurface surface{{read.points, {}}, {}};
  std::size_t larger = 0;
  for (const auto& polygon : read.polygons) {
    larger += polygon.size() > 3;
    const auto triangles = cut_polygon(read.points, polygon);
    surface.mesh.triangles.insert(surface.mesh.triangles.end(), triangles.begin(), triangles.end());
  }
  if (larger > 0)
    surface.findings.push_back({fmt::format("{} polygons of more than three sides", larger), "cut into triangles", {}});
  return surface;
}

ReadSurface read_obj(std::string_view bytes) {
  std::vector<Finding> findings;
  ReadSurface surface = triangles_of(read_obj_polygons(bytes, findings));
  surface.findings.insert(surface.findings.end(), findings.begin(), findings.end());
  return surface;
}

ReadSurface read(const fs::path& file) {
  if (has_ending(file, ".stl")) return read_stl(text_of(file));
  if (has_ending(file, ".vtp")) return triangles_of(read_vtp(text_of(file)));
  if (has_ending(file, ".obj")) return read_obj(text_of(file));
  if (has_ending(file, ".ply")) return triangles_of(read_ply(text_of(file)));
  if (has_ending(file, ".off")) return triangles_of(read_off(text_of(file)));
  if (!has_ending(file, ".vtk")) refuse(file, "a surface is read from .stl, .obj, .ply, .off, .vtk and .vtp files");
  if (const std::string text = text_of(file); is_polydata(text)) return triangles_of(read_polydata(text));
  return {load_triangle_mesh(file, 1), {}};
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
