#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

#include "common/mesh/obj_file.hpp"

namespace palpate {
namespace {

/// Rounded, without zeros at its end.
std::string short_number(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

}  // namespace

void write_obj(const VisualMesh& mesh, const std::filesystem::path& file, double metres_per_unit, int digits) {
  std::ofstream out(file, std::ios::binary);
  for (const Eigen::Vector3f& p : mesh.position) {
    out << 'v';
    for (const float x : p) out << ' ' << short_number(x / metres_per_unit, digits);
    out << '\n';
  }
  std::vector<int> image_place(mesh.position.size(), 0);
  int places = 0;
  for (const VisualMesh::Part& part : mesh.parts)
    for (int v = part.first; part.textured && v < part.first + part.count; ++v) {
      out << fmt::format("vt {} {}\n", short_number(mesh.image[v].x(), digits + 2),
                         short_number(1 - mesh.image[v].y(), digits + 2));
      image_place[v] = ++places;
    }
  for (const VisualMesh::Part& part : mesh.parts) {
    if (!part.material.empty()) out << "usemtl " << part.material << '\n';
    for (const auto& triangle : part.triangles) {
      out << 'f';
      for (const int corner : triangle) {
        const int v = part.first + corner;
        out << ' ' << v + 1;
        if (part.textured) out << '/' << image_place[v];
      }
      out << '\n';
    }
  }
  if (!out.flush()) throw std::runtime_error(file.string() + ": the file cannot be written");
}

}  // namespace palpate
