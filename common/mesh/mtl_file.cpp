#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "common/mesh/obj_file.hpp"
#include "common/mesh/text_lines.hpp"

namespace palpate {
namespace {

std::array<double, 3> colour_of(TextLines& lines) {
  std::array<double, 3> colour;
  for (double& channel : colour) {
    channel = lines.number();
    if (channel < 0 || channel > 1) lines.refuse(fmt::format("a colour goes from 0 to 1, not to {}", channel));
  }
  return colour;
}

/// Behind options such as `-s 1 1 1`, of which a name that begins with none has no more than blanks.
std::string image_of(std::string_view map) {
  if (map.starts_with('-')) map.remove_prefix(map.find_last_of(" \t") + 1);
  return std::string(map);
}

}  // namespace

ObjMaterials load_mtl(const std::filesystem::path& file) {
  TextLines lines(file);
  ObjMaterials materials;
  ObjMaterial* material = nullptr;
  while (lines.next()) {
    const std::string_view key = lines.key();
    if (key == "newmtl") {
      const std::string name(lines.rest());
      if (name.empty()) lines.refuse("a material has no name");
      const auto [entry, is_new] = materials.try_emplace(name);
      if (!is_new) lines.refuse(fmt::format("a second material is named '{}'", name));
      material = &entry->second;
    } else if (key == "Kd" || key == "map_Kd") {
      if (!material) lines.refuse(fmt::format("{} stands before the first newmtl", key));
      if (key == "Kd")
        material->colour = colour_of(lines);
      else
        material->textured = true, material->image = image_of(lines.rest());
    }
  }
  if (materials.empty()) throw std::runtime_error(file.string() + ": there is no material in it");
  return materials;
}

void write_mtl(const VisualMesh& mesh, const std::filesystem::path& file, const std::string& image) {
  std::ofstream out(file, std::ios::binary);
  for (const VisualMesh::Part& part : mesh.parts) {
    if (part.material.empty()) continue;
    out << fmt::format("newmtl {}\n", part.material);
    if (part.colour) out << fmt::format("Kd {} {} {}\n", (*part.colour)[0], (*part.colour)[1], (*part.colour)[2]);
    if (part.textured) out << fmt::format("map_Kd {}\n", image);
  }
  if (!out.flush()) throw std::runtime_error(file.string() + ": the file cannot be written");
}

}  // namespace palpate
